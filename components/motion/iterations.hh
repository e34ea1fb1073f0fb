// SPDX-License-Identifier: GPL-2.0-or-later
// A model whose forward side iterates, with pins that show the result.
#pragma once

#include "components/motion/model_pins.hh"

namespace mw::components {

template <class Model>
class IteratingModel {
  public:
    /// Creates the pins of the model and PREFIX.last-iterations and max-iterations. Returns 0 or a negated
    /// errno. [while loading]
    int declare(int comp_id, const char *prefix) noexcept {
        pins_ = static_cast<Pins *>(hal_malloc(static_cast<long>(sizeof(Pins))));
        if (pins_ == nullptr) {
            return -ENOMEM;
        }
        int status = hal_pin_u32_newf(HAL_OUT, &pins_->last, comp_id, "%s.last-iterations", prefix);
        status = status < 0 ? status
                            : hal_pin_u32_newf(HAL_OUT, &pins_->most, comp_id, "%s.max-iterations", prefix);
        return status < 0 ? status : pinned_.declare(comp_id, prefix);
    }
    Model model() const noexcept { return pinned_.model(); }
    kinematics::Status forward(const double *joints, kinematics::Pose &pose) const noexcept {
        int iterations = 0;
        const kinematics::Status status = pinned_.model().forward(joints, pose, iterations);
        const auto count = static_cast<rtapi_u32>(iterations);
        *pins_->last = count;
        if (isAnswered(status) && count > *pins_->most) {
            *pins_->most = count;
        }
        return status;
    }
    kinematics::Status inverse(const kinematics::Pose &pose, double *joints) const noexcept {
        return pinned_.inverse(pose, joints);
    }
    int side(const kinematics::Pose &pose) const noexcept { return pinned_.side(pose); }

  private:
    struct Pins {
        hal_u32_t *last, *most;
    };

    PinnedModel<Model> pinned_;
    Pins *pins_ = nullptr;
};

}  // namespace mw::components

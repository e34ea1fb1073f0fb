// SPDX-License-Identifier: GPL-2.0-or-later
// Kinematics of any arm of six turning joints (kinematics/serial.hh), switchable to identity. Pin (out)
// genserkins.last-iterations: of the inverse side.
#include "components/motion/switchable.hh"
#include "kinematics/serial.hh"

namespace {

struct SerialPins {
    hal_u32_t *last_iterations;
};

/// The model with the values of its pins, and the number of iterations it needed.
struct LiveSerial {
    mw::components::PinnedModel<mw::kinematics::Serial> pinned;
    SerialPins *pins = nullptr;

    mw::kinematics::Status forward(const double *joints, mw::kinematics::Pose &pose) const noexcept {
        return pinned.forward(joints, pose);
    }
    mw::kinematics::Status inverse(const mw::kinematics::Pose &pose, double *joints) const noexcept {
        int iterations = 0;
        const mw::kinematics::Status status = pinned.model().inverse(pose, joints, iterations);
        *pins->last_iterations = static_cast<rtapi_u32>(iterations);
        return status;
    }
};

LiveSerial live;

int declare_model(int comp_id, const char *) {
    live.pins = static_cast<SerialPins *>(hal_malloc(static_cast<long>(sizeof(SerialPins))));
    if (live.pins == nullptr) {
        return -ENOMEM;
    }
    const int status =
        hal_pin_u32_new("genserkins.last-iterations", HAL_OUT, &live.pins->last_iterations, comp_id);
    return status < 0 ? status : live.pinned.declare(comp_id, "genserkins");
}

}  // namespace

MW_SWITCHABLE_MODULE(live, "genserkins", "XYZABCUVW", declare_model);

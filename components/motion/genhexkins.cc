// SPDX-License-Identifier: GPL-2.0-or-later
// Kinematics of hexapods (kinematics/hexapod.hh), switchable to identity. Pins besides those of the model,
// (out): genhexkins.last-iterations and max-iterations of the forward kinematics, fwd-kins-fail if it found
// no solution, correction.N of the struts; (in) genhexkins.x to c: the start of the forward search if the
// last pose leads to no solution; skgui.x to c: the pose of the platform, with any type, for screens that
// draw it.
#include "components/motion/iterations.hh"
#include "components/motion/switchable.hh"
#include "kinematics/hexapod.hh"

namespace {

using mw::kinematics::Hexapod;
using mw::kinematics::Pose;
using mw::kinematics::Status;

struct HexapodPins {
    hal_float_t *guess[6];
    hal_float_t *correction[Hexapod::STRUTS];
    hal_bit_t *failed;
    hal_float_t *shown[6];
};

struct LiveHexapod {
    mw::components::IteratingModel<Hexapod> iterating;
    HexapodPins *pins = nullptr;

    void show(const Pose &pose) const noexcept {
        for (int i = 0; i < 6; ++i) {
            *pins->shown[i] = pose[i];
        }
    }
    /// Tracks the platform while another type is active. Only for the servo thread.
    void watch(const double *joints) const noexcept {
        Pose pose;
        for (int i = 0; i < 6; ++i) {
            pose[i] = *pins->shown[i];
        }
        if (isAnswered(iterating.model().forward(joints, pose))) {
            show(pose);
        }
    }

    /// Only for the servo thread; the planner calls the inverse.
    Status forward(const double *joints, Pose &pose) const noexcept {
        Status status = iterating.forward(joints, pose);
        if (status == Status::UNREACHABLE) {
            Pose guess = pose;
            for (int i = 0; i < 6; ++i) {
                guess[i] = *pins->guess[i];
            }
            status = iterating.forward(joints, guess);
            pose = isAnswered(status) ? guess : pose;
        }
        *pins->failed = status == Status::UNREACHABLE;
        if (isAnswered(status)) {
            const auto corrections = iterating.model().corrections_at(pose);
            for (std::size_t i = 0; i < Hexapod::STRUTS; ++i) {
                *pins->correction[i] = corrections[i];
            }
            show(pose);
        }
        return status;
    }
    Status inverse(const Pose &pose, double *joints) const noexcept {
        return iterating.inverse(pose, joints);
    }
    int side(const Pose &pose) const noexcept { return iterating.side(pose); }
};

LiveHexapod live;

int declare_model(int comp_id, const char *) {
    live.pins = static_cast<HexapodPins *>(hal_malloc(static_cast<long>(sizeof(HexapodPins))));
    if (live.pins == nullptr) {
        return -ENOMEM;
    }
    int status = hal_pin_bit_new("genhexkins.fwd-kins-fail", HAL_OUT, &live.pins->failed, comp_id);
    for (int i = 0; i < 6 && status >= 0; ++i) {
        status = hal_pin_float_newf(HAL_IN, &live.pins->guess[i], comp_id, "genhexkins.%c", "xyzabc"[i]);
        status = status < 0 ? status
                            : hal_pin_float_newf(HAL_OUT, &live.pins->correction[i], comp_id,
                                                 "genhexkins.correction.%d", i);
        status = status < 0
                     ? status
                     : hal_pin_float_newf(HAL_IN, &live.pins->shown[i], comp_id, "skgui.%c", "xyzabc"[i]);
    }
    return status < 0 ? status : live.iterating.declare(comp_id, "genhexkins");
}

}  // namespace

MW_SWITCHABLE_MODULE(live, "genhexkins", "XYZABCUVW", declare_model);

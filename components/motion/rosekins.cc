// SPDX-License-Identifier: GPL-2.0-or-later
// Kinematics of rose engines (kinematics/rose.hh). Pins (out): rosekins.revolutions, whole revolutions of the
// work; theta_degrees, its angle within a revolution, -180 to 180; bigtheta_degrees, including the
// revolutions.
#include <cerrno>
#include <cmath>

#include "components/motion/kinematics_module.hh"
#include "kinematics/rose.hh"

namespace {

struct RosePins {
    hal_float_t *revolutions, *theta, *big_theta;
};

/// The model, and the position of the work on its pins.
struct LiveRose {
    mw::kinematics::Rose model;
    RosePins *pins = nullptr;

    /// Only for the servo thread; the planner calls the inverse.
    mw::kinematics::Status forward(const double *joints, mw::kinematics::Pose &pose) const noexcept {
        const mw::kinematics::Status status = model.forward(joints, pose);
        if (isAnswered(status)) {
            const double turns = std::round(joints[2] / 360.0);
            *pins->revolutions = turns;
            *pins->theta = joints[2] - 360.0 * turns;
            *pins->big_theta = joints[2];
        }
        return status;
    }
    mw::kinematics::Status inverse(const mw::kinematics::Pose &pose, double *joints) const noexcept {
        return model.inverse(pose, joints);
    }
};

LiveRose live;

int declare_pins(int comp_id) {
    live.pins = static_cast<RosePins *>(hal_malloc(static_cast<long>(sizeof(RosePins))));
    if (live.pins == nullptr) {
        return -ENOMEM;
    }
    int status = hal_pin_float_new("rosekins.revolutions", HAL_OUT, &live.pins->revolutions, comp_id);
    status = status < 0 ? status
                        : hal_pin_float_new("rosekins.theta_degrees", HAL_OUT, &live.pins->theta, comp_id);
    return status < 0
               ? status
               : hal_pin_float_new("rosekins.bigtheta_degrees", HAL_OUT, &live.pins->big_theta, comp_id);
}

}  // namespace

MW_KINEMATICS(live);
MW_KINEMATICS_PURE;
MW_KINEMATICS_MAIN("rosekins", declare_pins);

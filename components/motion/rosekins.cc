// SPDX-License-Identifier: GPL-2.0-or-later
// Kinematics of rose engines (kins/rose.hh). Pins (out): rosekins.revolutions, whole turns of the work;
// theta_degrees, its angle within one, -180 to 180; bigtheta_degrees, with the turns.
#include <cerrno>
#include <cmath>

#include "components/motion/kinematics_module.hh"
#include "kins/rose.hh"

namespace {

struct RosePins {
    hal_float_t *revolutions, *theta, *big_theta;
};

/// The model, and where the work is on the pins.
struct LiveRose {
    mw::kins::Rose model;
    RosePins *pins = nullptr;

    /// Of the servo thread only; the planner asks the other way.
    mw::kins::Status forward(const double *joints, mw::kins::Pose &pose) const noexcept {
        const mw::kins::Status status = model.forward(joints, pose);
        if (isAnswered(status)) {
            const double turns = std::round(joints[2] / 360.0);
            *pins->revolutions = turns;
            *pins->theta = joints[2] - 360.0 * turns;
            *pins->big_theta = joints[2];
        }
        return status;
    }
    mw::kins::Status inverse(const mw::kins::Pose &pose, double *joints) const noexcept {
        return model.inverse(pose, joints);
    }
};

LiveRose live;
int component = -1;

int declare() {
    live.pins = static_cast<RosePins *>(hal_malloc(static_cast<long>(sizeof(RosePins))));
    if (live.pins == nullptr) {
        return -ENOMEM;
    }
    int status = hal_pin_float_new("rosekins.revolutions", HAL_OUT, &live.pins->revolutions, component);
    status = status < 0 ? status
                        : hal_pin_float_new("rosekins.theta_degrees", HAL_OUT, &live.pins->theta, component);
    return status < 0
               ? status
               : hal_pin_float_new("rosekins.bigtheta_degrees", HAL_OUT, &live.pins->big_theta, component);
}

}  // namespace

MW_KINEMATICS(live);
MW_KINEMATICS_PURE;

int rtapi_app_main(void) {
    component = hal_init("rosekins");
    const int status = component < 0 ? component : declare();
    if (status < 0) {
        hal_exit(component);
        return status;
    }
    return hal_ready(component);
}

void rtapi_app_exit(void) {
    hal_exit(component);
}

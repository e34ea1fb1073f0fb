// SPDX-License-Identifier: GPL-2.0-or-later
#include "motion/servo/feedback.hh"

namespace mw::motion {

std::uint32_t read_feedback(ControllerParts &parts, const Inputs &in) noexcept {
    parts.homing.read_pins();
    const PerJoint measured = parts.joints.read_feedback(in);
    parts.position.read_feedback(parts.model.kinematics(), measured.data(),
                                 parts.model.limits().homed.areAll);
    return parts.spindles.read_feedback(in);
}

}  // namespace mw::motion

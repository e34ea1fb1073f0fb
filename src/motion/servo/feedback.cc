// SPDX-License-Identifier: GPL-2.0-or-later
#include "motion/servo/feedback.hh"

namespace mw::motion {

std::uint32_t read_feedback(ControllerParts &parts, const Inputs &in) noexcept {
    if (parts.homing.foreign != nullptr) [[unlikely]] {
        parts.homing.foreign->read_pins();
    }
    const PerJoint measured = read_feedback(parts.joints, in);
    parts.position.read_feedback(parts.model.kinematics(), measured.data(),
                                 parts.model.limits().homed.areAll);
    return measure(parts.spindles, in);
}

}  // namespace mw::motion

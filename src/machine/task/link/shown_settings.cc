// SPDX-License-Identifier: GPL-2.0-or-later
#include "machine/task/link/shown_settings.hh"

#include <algorithm>

#include "motion/interface/parameters.hh"

namespace mw::task {

void ShownSettings::note(const motion::SetParameter &parameter) {
    using motion::Parameter;
    settings_.set(parameter, MAX_JOINTS, MAX_SPINDLES);
    const auto index = static_cast<std::size_t>(std::max<int>(parameter.index, 0));
    messages::JointSettings &joint = shown_.joints[std::min<std::size_t>(index, MAX_JOINTS - 1)];
    switch (static_cast<Parameter>(parameter.parameter)) {
    case Parameter::TRAJ_MAX_VELOCITY:
        most_velocity_ = parameter.value;
        shown_.max_velocity = parameter.value;
        break;
    case Parameter::TRAJ_MAX_ACCELERATION: shown_.max_acceleration = parameter.value; break;
    case Parameter::JOINT_BACKLASH: joint.backlash = parameter.value; break;
    case Parameter::JOINT_FERROR: joint.max_ferror = parameter.value; break;
    case Parameter::JOINT_MIN_FERROR: joint.min_ferror = parameter.value; break;
    case Parameter::JOINT_IS_ANGULAR:
        joint.kind = parameter.value != 0 ? messages::JointKind::ANGULAR : messages::JointKind::LINEAR;
        joint.units = parameter.value != 0 ? shown_.angular_units : shown_.linear_units;
        break;
    default: break;
    }
}

void ShownSettings::limit_velocity(double velocity) {
    shown_.max_velocity = std::min(velocity, most_velocity_);
}

}  // namespace mw::task

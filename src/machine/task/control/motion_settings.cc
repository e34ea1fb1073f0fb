// SPDX-License-Identifier: GPL-2.0-or-later
#include "machine/task/control/motion_settings.hh"

#include <algorithm>
#include <span>

#include "machine/task/link/joint_settings.hh"
#include "motion/interface/texts.hh"

namespace mw::task {

void MotionSettings::configure(const std::vector<motion::SetParameter> &parameters,
                               const ScrewTables &tables) {
    for (const auto &table : tables) {
        port_.link().send_table(table);
    }
    for (const motion::SetParameter &parameter : parameters) {
        change(parameter);
    }
    port_.send(motion::SetNumJoints{num_joints_});
    last_ = port_.send(motion::SetWatchdog{true, watchdog_s_});
}

void MotionSettings::note_refusal(const MotionLink::Refusal &refusal) {
    const auto &[answer, source, is_table] = refusal;
    if (refused_.empty() && !answer.isPath && (is_table || answer.id <= last_)) {
        refused_ = motion::reason_text(answer);
    }
}

Result<bool> MotionSettings::isConfigured() const {
    const bool answered = port_.isAnswered(last_) && port_.link().areTablesAnswered();
    if (answered && !refused_.empty()) {
        return fail("a setting was rejected: " + refused_);
    }
    return answered;
}

Result<Progress> MotionSettings::change_joint(mailbox::Serial command,
                                              const std::vector<motion::SetParameter> &changes, bool homing) {
    const auto checked = check_settings(changes, current(), {num_joints_, homing});
    if (!checked.has_value()) {
        return std::unexpected(checked.error());
    }
    for (const motion::SetParameter &setting : std::span(changes).first(changes.size() - 1)) {
        change(setting);
    }
    note(changes.back());
    return port_.order(command, changes.back());
}

void MotionSettings::note(const motion::SetParameter &parameter) {
    using motion::Parameter;
    current_.set(parameter, MAX_JOINTS, MAX_SPINDLES);
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

}  // namespace mw::task

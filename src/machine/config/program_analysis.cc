// SPDX-License-Identifier: GPL-2.0-or-later
#include "machine/config/program_analysis.hh"

#include <algorithm>
#include <array>
#include <string>

#include <fmt/format.h>

#include "machine/task/run/task_canon.hh"
#include "motion/interface/parameters.hh"

namespace mw::machine {
namespace {

/// INI key of the tightest limit, of an axis or of the joints that move it.
std::string key_of_limit(const MachineConfig &machine, const motion::FoldedLimits &limits, int axis,
                         bool is_low) {
    const double axis_limit =
        motion::settings_of(machine.parameters)
            .get(is_low ? motion::Parameter::AXIS_MIN_LIMIT : motion::Parameter::AXIS_MAX_LIMIT, axis);
    const double limit = is_low ? limits.low[axis] : limits.high[axis];
    std::string section = std::string("AXIS_") + geometry::AXIS_LETTERS[axis];
    for (int joint = 0; joint < machine.num_joints; ++joint) {
        const auto j = static_cast<std::size_t>(joint);
        const double own = is_low ? limits.joints.low[j] : limits.joints.high[j];
        const bool is_joint = machine.axis_map.moves(joint, axis) && own == limit;
        section = is_joint && limit != axis_limit ? "JOINT_" + std::to_string(joint) : section;
    }
    return fmt::format("[{}]{}_LIMIT", section, is_low ? "MIN" : "MAX");
}

}  // namespace

geometry::Pose home_position(const MachineConfig &machine) {
    if (!machine.isTrivial) {
        const motion::FoldedLimits limits = machine.limits();
        geometry::Pose within;
        for (int axis = 0; axis < MAX_AXES; ++axis) {
            within[axis] = std::max(limits.low[axis], std::min(0.0, limits.high[axis]));
        }
        return within;
    }
    std::array<double, MAX_JOINTS> home{};
    for (const motion::SetParameter &parameter : machine.parameters) {
        const bool is_home = parameter.parameter == static_cast<std::uint16_t>(motion::Parameter::JOINT_HOME);
        if (is_home && parameter.index >= 0 && parameter.index < MAX_JOINTS) {
            home[static_cast<std::size_t>(parameter.index)] = parameter.value;
        }
    }
    geometry::Pose position;
    for (int axis = 0; axis < MAX_AXES; ++axis) {
        const int joint = machine.joint_of_axis[static_cast<std::size_t>(axis)];
        position[axis] = joint >= 0 ? home[static_cast<std::size_t>(joint)] : 0.0;
    }
    return position;
}

gcode::PreviewMachine preview_stand(const MachineConfig &machine) {
    gcode::PreviewMachine stand;
    stand.interpreter = machine.task.interpreter;
    stand.units = machine.task.machine_units;
    stand.axis_mask = machine.axis_mask;
    stand.spindles = machine.num_spindles;
    stand.parameter_file = machine.task.parameter_file;
    stand.position = home_position(machine);
    stand.tool_change_moves = [&machine](const geometry::Pose &position) {
        return task::tool_change_moves(machine.task.tool_change_place, position);
    };
    return stand;
}

gcode::TimedMachine timed_machine(const MachineConfig &machine) {
    const motion::Settings settings = motion::settings_of(machine.parameters);
    const motion::FoldedLimits limits = machine.limits();
    gcode::TimedMachine timed;
    timed.limits = motion::fold_limits(settings, machine.axis_map, motion::ALL_HOMED).path;
    timed.low = limits.low;
    timed.high = limits.high;
    timed.corner_scale = settings.get(motion::Parameter::TRAJ_CORNER_SCALE);
    timed.has_jerk_limit = settings.get(motion::Parameter::TRAJ_MAX_JERK) >= motion::LEAST_JERK;
    timed.servo_period_s = static_cast<double>(machine.servo_period_ns) * 1e-9;
    return timed;
}

gcode::CheckedMachine checked_machine(const MachineConfig &machine) {
    gcode::CheckedMachine checked;
    checked.start = preview_stand(machine);
    checked.limits = timed_machine(machine);
    checked.limit_key = [&machine, limits = machine.limits()](int axis, bool is_low) {
        return key_of_limit(machine, limits, axis, is_low);
    };
    checked.is_start_known = machine.isTrivial;
    return checked;
}

}  // namespace mw::machine

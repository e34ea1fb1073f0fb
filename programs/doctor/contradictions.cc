// SPDX-License-Identifier: GPL-2.0-or-later
#include "programs/doctor/contradictions.hh"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include <fmt/format.h>

#include "base/geometry/pose.hh"
#include "base/text.hh"
#include "programs/doctor/settings.hh"

namespace mw::doctor {
namespace {

using ini::IniFile;
using machine::MachineConfig;

std::string joint_section(int joint) {
    return "JOINT_" + std::to_string(joint);
}

std::string axis_section(int axis) {
    return std::string("AXIS_") + geometry::AXIS_LETTERS[axis];
}

/// Two settings of which the first must not exceed the second.
struct Order {
    const char *low, *high;
    const char *consequence;
    diagnostics::Severity severity = diagnostics::Severity::WARNING;
    bool is_zero_none = false;  ///< the second setting is not a limit if it is 0
};

void examine_order(const IniFile &ini, const std::string &section, const Order &order,
                   diagnostics::Sink &sink) {
    const auto low = number(ini, section, order.low);
    const auto high = number(ini, section, order.high);
    const bool unlimited = order.is_zero_none && high.has_value() && high->value == 0;
    if (low.has_value() && high.has_value() && low->value > high->value && !unlimited) {
        sink.report({order.severity,
                     {fmt::format("{} is above {}: {}", low->str(), high->str(), order.consequence),
                      low->place(),
                      {}}});
    }
}

constexpr Order JOINT_TRAVEL = {"MIN_LIMIT", "MAX_LIMIT", "the joint cannot move",
                                diagnostics::Severity::ERROR};
constexpr const char *NO_FOLLOWING = "the step generator cannot follow, and the joint gets a following error";
constexpr std::array JOINT_ORDERS = {
    Order{"MIN_FERROR", "FERROR", "the limit at standstill is larger than at full speed"},
    Order{"MAX_VELOCITY", "STEPGEN_MAXVEL", NO_FOLLOWING, diagnostics::Severity::WARNING, true},
    Order{"MAX_ACCELERATION", "STEPGEN_MAXACCEL", NO_FOLLOWING, diagnostics::Severity::WARNING, true},
};
constexpr std::array SPINDLE_ORDERS = {
    Order{"MIN_VELOCITY", "MAX_VELOCITY", "no spindle speed is possible"},
    Order{"MIN_FORWARD_VELOCITY", "MAX_FORWARD_VELOCITY", "M3 has no possible speed"},
    Order{"MIN_REVERSE_VELOCITY", "MAX_REVERSE_VELOCITY", "M4 has no possible speed"},
};
constexpr std::array DISPLAY_ORDERS = {
    Order{"MIN_LINEAR_VELOCITY", "MAX_LINEAR_VELOCITY", "no jog speed is possible"},
    Order{"DEFAULT_LINEAR_VELOCITY", "MAX_LINEAR_VELOCITY", "jogs start at the maximum speed"},
    Order{"MIN_ANGULAR_VELOCITY", "MAX_ANGULAR_VELOCITY", "no jog speed is possible"},
    Order{"DEFAULT_ANGULAR_VELOCITY", "MAX_ANGULAR_VELOCITY", "jogs start at the maximum speed"},
};
constexpr std::array TRAJ_ORDERS = {
    Order{"DEFAULT_LINEAR_VELOCITY", "MAX_LINEAR_VELOCITY", "the latter is used"},
    Order{"DEFAULT_LINEAR_ACCELERATION", "MAX_LINEAR_ACCELERATION", "the latter is used"},
    Order{"DEFAULT_ANGULAR_VELOCITY", "MAX_ANGULAR_VELOCITY", "the latter is used"},
    Order{"DEFAULT_ANGULAR_ACCELERATION", "MAX_ANGULAR_ACCELERATION", "the latter is used"},
};

/// Settings that homing rejects or interprets unexpectedly. Speeds with their signs; 0 is none.
void examine_homing(const IniFile &ini, const std::string &section, diagnostics::Sink &sink) {
    const auto search = number(ini, section, "HOME_SEARCH_VEL");
    const auto latch = number(ini, section, "HOME_LATCH_VEL");
    const auto fastest = number(ini, section, "MAX_VELOCITY");
    const std::string index = to_lower(text(ini, section, "HOME_USE_INDEX"));
    const bool usesIndex = index == "yes" || index == "true" || index == "1" || index == "on";
    const bool searches = search.has_value() && search->value != 0;
    const bool latches = latch.has_value() && latch->value != 0;
    if (searches && !latches) {
        sink.error(search->str() + " without HOME_LATCH_VEL: homing does not start", search->place(),
                   "the speed at which the switch edge is latched");
    }
    if (!searches && latches && !usesIndex) {
        sink.error(latch->str() + " with neither HOME_SEARCH_VEL nor HOME_USE_INDEX: homing does not start",
                   latch->place());
    }
    if (searches && latches && std::fabs(latch->value) > std::fabs(search->value)) {
        sink.warning(latch->str() +
                         " is faster than HOME_SEARCH_VEL: the switch edge is latched less accurately",
                     latch->place());
    }
    if (searches && fastest.has_value() && std::fabs(search->value) > fastest->value) {
        sink.note(search->str() + " is above " + fastest->str() + ": the latter is used", search->place());
    }
}

/// Factors that HAL files multiply or divide by.
void examine_scales(const IniFile &ini, const std::string &section, diagnostics::Sink &sink) {
    for (const char *key : {"SCALE", "STEP_SCALE", "INPUT_SCALE", "OUTPUT_SCALE", "ENCODER_SCALE"}) {
        const auto scale = number(ini, section, key);
        if (scale.has_value() && scale->value == 0) {
            sink.error(scale->str() + ": the joint has no unit", scale->place(),
                       "steps or counts per machine unit");
        }
    }
}

/// Sequence numbers are consecutive from 0 or 1.
void examine_home_order(const IniFile &ini, const MachineConfig &machine, diagnostics::Sink &sink) {
    std::set<int> used;
    const ini::IniEntry *highest = nullptr;
    for (int joint = 0; joint < machine.num_joints; ++joint) {
        const auto sequence = number(ini, joint_section(joint), "HOME_SEQUENCE");
        if (sequence.has_value() && std::fabs(sequence->value) < 1000) {
            const int place = static_cast<int>(std::fabs(sequence->value));
            highest = used.empty() || place > *used.rbegin() ? sequence->entry : highest;
            used.insert(place);
        }
    }
    if (used.empty()) {
        return;
    }
    int expected = *used.begin();
    const bool gapless =
        expected <= 1 && std::ranges::all_of(used, [&expected](int place) { return place == expected++; });
    if (!gapless) {
        sink.warning(
            fmt::format("HOME_SEQUENCE has {}: use consecutive numbers from 0 or 1", fmt::join(used, ", ")),
            highest->place);
    }
}

/// Reports limits of an axis that exceed those of its joint. Only for trivial kinematics.
void examine_axis(const IniFile &ini, const MachineConfig &machine, int axis, diagnostics::Sink &sink) {
    const int joint = machine.joint_of_axis[static_cast<std::size_t>(axis)];
    if (!machine.isTrivial || joint < 0) {
        return;
    }
    const std::string its = axis_section(axis);
    const std::string of_joint = joint_section(joint);
    const auto compare = [&](const char *key, bool upper) {
        const auto mine = number(ini, its, key);
        const auto theirs = number(ini, of_joint, key);
        if (!mine.has_value() || !theirs.has_value()) {
            return;
        }
        const double tolerance = 1e-2 * std::max(1.0, std::fabs(theirs->value));
        const double beyond = upper ? mine->value - theirs->value : theirs->value - mine->value;
        if (beyond > tolerance) {
            sink.warning(mine->str() + " exceeds " + theirs->str() + ": the latter is used", mine->place());
        }
    };
    compare("MAX_VELOCITY", true);
    compare("MAX_ACCELERATION", true);
    compare("MAX_LIMIT", true);
    compare("MIN_LIMIT", false);
    const std::string type = to_upper(text(ini, of_joint, "TYPE"));
    const bool mixed = type == (geometry::isAngular(axis) ? "LINEAR" : "ANGULAR");
    if (mixed) {
        sink.warning(fmt::format("[{}]TYPE = {} moves axis {}, which {}: its unit is wrong", of_joint, type,
                                 geometry::AXIS_LETTERS[axis],
                                 geometry::isAngular(axis) ? "is rotary" : "is linear"),
                     ini.find(of_joint, "TYPE")->place);
    }
}

/// Sections of axes that the machine does not have, and axes without a joint.
void examine_letters(const IniFile &ini, const MachineConfig &machine, diagnostics::Sink &sink) {
    const auto letters = static_cast<int>(machine.coordinates.size());
    const ini::IniEntry *const joints = ini.find("KINS", "JOINTS");
    const bool plain = machine.isTrivial && machine.kinematics.size() == 1;
    if (plain && joints != nullptr && letters > machine.num_joints) {
        sink.error(fmt::format("[TRAJ]COORDINATES has {} letters, [KINS]JOINTS = {}: axes without a joint",
                               letters, machine.num_joints),
                   joints->place, "set [KINS]JOINTS to the number of letters");
    }
    for (int axis = 0; axis < MAX_AXES; ++axis) {
        const std::string section = axis_section(axis);
        const bool is_part = (machine.axis_mask & (1U << axis)) != 0;
        if (!is_part && ini.hasSection(section) && machine.axis_mask != 0) {
            sink.warning(
                fmt::format("section [{}] belongs to an axis that is not in [TRAJ]COORDINATES", section),
                ini.place_of_section(section));
        }
        if (is_part && machine.isTrivial && !plain &&
            machine.joint_of_axis[static_cast<std::size_t>(axis)] < 0) {
            sink.warning(
                fmt::format("[TRAJ]COORDINATES names {}, coordinates= of [KINS]KINEMATICS does not: no "
                            "joint moves the axis",
                            geometry::AXIS_LETTERS[axis]),
                ini.find("TRAJ", "COORDINATES")->place);
        }
    }
}

/// Values that are probably millimetres on a machine in inches.
void examine_units(const IniFile &ini, const MachineConfig &machine, diagnostics::Sink &sink) {
    constexpr double FAST_IN_S = 60, LONG_IN = 1000;  // 1.5 m/s and 25 m
    const ini::IniEntry *const units = ini.find("TRAJ", "LINEAR_UNITS");
    if (machine.metric || units == nullptr) {
        return;
    }
    for (int axis = 0; axis < MAX_AXES; ++axis) {
        if ((machine.axis_mask & (1U << axis)) == 0 || geometry::isAngular(axis)) {
            continue;
        }
        const std::string section = axis_section(axis);
        const auto speed = number(ini, section, "MAX_VELOCITY");
        const auto low = number(ini, section, "MIN_LIMIT");
        const auto high = number(ini, section, "MAX_LIMIT");
        const bool fast = speed.has_value() && speed->value > FAST_IN_S;
        const bool is_long = low.has_value() && high.has_value() && high->value - low->value > LONG_IN &&
                             high->value - low->value < 1e6;
        if (fast || is_long) {
            sink.warning(fmt::format("{} with [TRAJ]LINEAR_UNITS = {}: are these millimetres?",
                                     fast ? speed->str() : high->str(), units->value),
                         fast ? speed->place() : high->place());
        }
    }
}

void examine_periods(const IniFile &ini, diagnostics::Sink &sink) {
    const auto base = number(ini, "EMCMOT", "BASE_PERIOD");
    const auto servo = number(ini, "EMCMOT", "SERVO_PERIOD");
    if (base.has_value() && servo.has_value() && base->value > servo->value && servo->value > 0) {
        sink.error(base->str() + " is longer than " + servo->str(), base->place(),
                   "the base thread must be faster than the servo thread; 0: no base thread");
    }
    const auto task = number(ini, "TASK", "CYCLE_TIME");
    constexpr double SLOW_S = 0.2;
    if (task.has_value() && task->value > SLOW_S) {
        sink.warning(task->str() + " s delays each command of the operator by this time", task->place());
    }
}

void examine_overrides(const IniFile &ini, const MachineConfig &machine, diagnostics::Sink &sink) {
    const ini::IniEntry *const entry = ini.find("DISPLAY", "MIN_SPINDLE_OVERRIDE");
    if (entry != nullptr && machine.panel.min_spindle_override > machine.panel.max_spindle_override) {
        sink.warning(
            fmt::format(
                "[DISPLAY]MIN_SPINDLE_OVERRIDE = {} is above MAX_SPINDLE_OVERRIDE, {}: no override is "
                "possible",
                entry->value, to_text(machine.panel.max_spindle_override)),
            entry->place);
    }
}

}  // namespace

void examine_contradictions(const IniFile &ini, const MachineConfig &machine, diagnostics::Sink &sink) {
    examine_letters(ini, machine, sink);
    examine_units(ini, machine, sink);
    examine_periods(ini, sink);
    examine_overrides(ini, machine, sink);
    for (const Order &order : TRAJ_ORDERS) {
        examine_order(ini, "TRAJ", order, sink);
    }
    for (const Order &order : DISPLAY_ORDERS) {
        examine_order(ini, "DISPLAY", order, sink);
    }
    for (int joint = 0; joint < machine.num_joints; ++joint) {
        const std::string section = joint_section(joint);
        examine_order(ini, section, JOINT_TRAVEL, sink);
        for (const Order &order : JOINT_ORDERS) {
            examine_order(ini, section, order, sink);
        }
        examine_homing(ini, section, sink);
        examine_scales(ini, section, sink);
    }
    examine_home_order(ini, machine, sink);
    for (int axis = 0; axis < MAX_AXES; ++axis) {
        if ((machine.axis_mask & (1U << axis)) != 0) {
            examine_axis(ini, machine, axis, sink);
        }
    }
    for (int spindle = 0; spindle < machine.num_spindles; ++spindle) {
        for (const Order &order : SPINDLE_ORDERS) {
            examine_order(ini, "SPINDLE_" + std::to_string(spindle), order, sink);
        }
    }
}

}  // namespace mw::doctor

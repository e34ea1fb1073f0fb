// SPDX-License-Identifier: GPL-2.0-or-later
#include <cmath>
#include <filesystem>

#include <fmt/format.h>

#include "base/text.hh"
#include "clients/tcl/commands.hh"
#include "messages/legacy/forms.hh"
#include "messages/legacy/units.hh"

namespace mw::tcl {
namespace {

using Text = Result<std::string>;

std::string digit(bool on) {
    return on ? "1" : "0";
}

Result<int> whole(const Words &words, std::size_t place, const char *what) {
    const auto value = parse_int(words.size() > place ? words[place] : "");
    const bool is_whole = value.has_value() && *value >= INT32_MIN && *value <= INT32_MAX;
    return is_whole ? Result<int>(static_cast<int>(*value))
                    : fail(fmt::format("{} is a whole number, not '{}'", what,
                                       words.size() > place ? printable(words[place]) : ""));
}

/// The words of an order that may end with the number of a spindle; without a number the first spindle.
struct OfSpindle {
    Words order;
    int spindle = 0;
};

Result<OfSpindle> of_spindle(const Shell &shell, const Words &words) {
    OfSpindle out{words, 0};
    const auto number = words.empty() ? std::nullopt : parse_int(words.back());
    if (!number.has_value()) {
        return out;
    }
    const int count = shell.status().trajectory.num_spindles;
    if (*number < 0 || *number >= count) {
        return fail(fmt::format("there is no spindle {}: 0 to {}", *number, count - 1));
    }
    out.spindle = static_cast<int>(*number);
    out.order.pop_back();
    return out;
}

const messages::SpindleStatus &spindle_at(const Shell &shell, int number) {
    return shell.status().spindles[static_cast<std::size_t>(number)];
}

Text brake(Shell &shell, const Words &words) {
    const auto asked = of_spindle(shell, words);
    if (!asked.has_value()) {
        return std::unexpected(asked.error());
    }
    return asked->order.empty() ? Text(spindle_at(shell, asked->spindle).isBrakeOn ? "on" : "off")
                                : shell.ask("BRAKE", {asked->order[0], std::to_string(asked->spindle)});
}

Text spindle(Shell &shell, const Words &words) {
    const auto asked = of_spindle(shell, words);
    if (!asked.has_value()) {
        return std::unexpected(asked.error());
    }
    if (asked->order.empty()) {
        const int direction = spindle_at(shell, asked->spindle).direction;
        return direction > 0 ? "forward" : direction < 0 ? "reverse" : "off";
    }
    return shell.ask("SPINDLE", {asked->order[0], std::to_string(asked->spindle)});
}

std::string percent(double factor) {
    return legacy::text(legacy::Form::PERCENT, legacy::Dialect::TCL, factor);
}

Text rapid_override(Shell &shell, const Words &words) {
    if (words.empty()) {
        return percent(shell.status().overrides.rapid);
    }
    const auto value = parse_double(words[0]);
    return value.has_value() && *value >= 0 ? shell.send(messages::SetRapidOverride{legacy::factor(*value)})
                                            : fail("a percentage is a number from 0 on");
}

Text spindle_override(Shell &shell, const Words &words) {
    return words.empty() ? Text(percent(spindle_at(shell, 0).override_factor))
                         : shell.ask("SPINDLE_OVERRIDE", words);
}

struct Target {
    rsh::JogTarget of;
    double velocity = 0;
};

/// N JJOG [SPEED]
Result<Target> target(const Words &words) {
    const auto index = whole(words, 0, "the joint or axis"), isJoint = whole(words, 1, "joint-jog");
    if (!index.has_value() || !isJoint.has_value()) {
        return std::unexpected(index.has_value() ? isJoint.error() : index.error());
    }
    const int count = *isJoint != 0 ? MAX_JOINTS : geometry::AXIS_COUNT;
    if (*index < 0 || *index >= count) {
        return fail(fmt::format("there is no {} {}", *isJoint != 0 ? "joint" : "axis", *index));
    }
    Target out{{*isJoint != 0, *index}, 0};
    constexpr std::size_t SPEED = 2;
    if (words.size() > SPEED) {
        const auto speed = parse_double(words[SPEED]);
        if (!speed.has_value()) {
            return fail(fmt::format("a speed is a number, not '{}'", printable(words[SPEED])));
        }
        out.velocity = legacy::per_second(*speed);
    }
    return out;
}

Text jog(Shell &shell, const Words &words) {
    const auto wanted = target(words);
    return wanted.has_value() ? shell.jog(wanted->of, wanted->velocity) : std::unexpected(wanted.error());
}

Text jog_increment(Shell &shell, const Words &words) {
    const auto wanted = target(words);
    const auto distance = parse_double(words[3]);
    if (!wanted.has_value() || !distance.has_value()) {
        return wanted.has_value() ? Text(fail("a distance is a number")) : std::unexpected(wanted.error());
    }
    // The sign of the speed is the direction, as in a continuous jog.
    const double way = wanted->velocity < 0 ? -std::fabs(*distance) : std::fabs(*distance);
    return shell.send(
        messages::JogIncrement{wanted->of.isJoint, wanted->of.index, std::fabs(wanted->velocity), way});
}

Text jog_stop(Shell &shell, const Words &words) {
    const auto wanted = target(words);
    return wanted.has_value() ? shell.stop_jog(wanted->of) : std::unexpected(wanted.error());
}

Text home(Shell &shell, const Words &words) {
    const auto joint = whole(words, 0, "the joint");
    return joint.has_value() ? shell.send(messages::HomeJoint{*joint}) : std::unexpected(joint.error());
}
Text unhome(Shell &shell, const Words &words) {
    const auto joint = whole(words, 0, "the joint");
    return joint.has_value() ? shell.send(messages::UnhomeJoint{*joint}) : std::unexpected(joint.error());
}

Text open(Shell &shell, const Words &words) {
    std::error_code ignored;
    return shell.send(messages::OpenProgram{std::filesystem::absolute(words[0], ignored).string()});
}

Text joint_enable(Shell &shell, const Words &words) {
    const auto joint = whole(words, 0, "the joint");
    if (!joint.has_value() || *joint < 0 || *joint >= MAX_JOINTS) {
        return joint.has_value() ? Text(fail("there is no such joint")) : std::unexpected(joint.error());
    }
    if (words.size() == 1) {
        return digit(shell.status().joints[static_cast<std::size_t>(*joint)].isEnabled);
    }
    const auto on = rsh::on_or_off(words[1]);
    if (!on.has_value()) {
        return std::unexpected(on.error());
    }
    return *on ? shell.send(messages::EnableJoint{*joint}) : shell.send(messages::DisableJoint{*joint});
}

Text joint_backlash(Shell &shell, const Words &words) {
    const auto joint = whole(words, 0, "the joint");
    if (!joint.has_value() || *joint < 0 || *joint >= MAX_JOINTS) {
        return joint.has_value() ? Text(fail("there is no such joint")) : std::unexpected(joint.error());
    }
    const auto number = static_cast<std::size_t>(*joint);
    if (words.size() == 1) {
        return fmt::format("{:.6g}", shell.status().settings.joints[number].backlash);
    }
    const auto value = parse_double(words[1]);
    return value.has_value() ? shell.send(messages::SetJointBacklash{*joint, *value})
                             : fail("a backlash is a number");
}

Text joint_load_comp(Shell &shell, const Words &words) {
    const auto joint = whole(words, 0, "the joint"), kind = whole(words, 2, "the type");
    if (!joint.has_value() || !kind.has_value()) {
        return std::unexpected(joint.has_value() ? kind.error() : joint.error());
    }
    return shell.send(messages::LoadCompensation{*joint, words[1], *kind});
}

constexpr CommandRow ROWS[] = {
    {"emc_abort", 0, 0, "", [](Shell &s, const Words &) { return s.ask("ABORT"); }},
    {"emc_brake", 0, 2, "[on|off] [spindle]", brake},
    {"emc_home", 1, 1, "joint|-1", home},
    {"emc_jog", 3, 3, "number joint-jog speed", jog},
    {"emc_jog_incr", 4, 4, "number joint-jog speed distance", jog_increment},
    {"emc_jog_stop", 2, 2, "number joint-jog", jog_stop},
    {"emc_joint_backlash", 1, 2, "joint [backlash]", joint_backlash},
    {"emc_joint_enable", 1, 2, "joint [0|1]", joint_enable},
    {"emc_joint_load_comp", 3, 3, "joint file type", joint_load_comp},
    {"emc_load_tool_table", 0, 1, "[file]",
     [](Shell &s, const Words &w) { return s.ask("LOAD_TOOL_TABLE", w); }},
    {"emc_mdi", 1, 100, "line", [](Shell &s, const Words &w) { return s.ask("MDI", w); }},
    {"emc_open", 1, 1, "file", open},
    {"emc_pause", 0, 0, "", [](Shell &s, const Words &) { return s.ask("PAUSE"); }},
    {"emc_probe_clear", 0, 0, "", [](Shell &s, const Words &) { return s.ask("PROBE_CLEAR"); }},
    {"emc_probe_move", 3, 3, "x y z", [](Shell &s, const Words &w) { return s.ask("PROBE", w); }},
    {"emc_rapid_override", 0, 1, "[percent]", rapid_override},
    {"emc_resume", 0, 0, "", [](Shell &s, const Words &) { return s.ask("RESUME"); }},
    {"emc_run", 0, 1, "[line]", [](Shell &s, const Words &w) { return s.ask("RUN", w); }},
    {"emc_set_tool_offset", 3, 3, "tool length diameter",
     [](Shell &s, const Words &w) { return s.ask("TOOL_OFFSET", w); }},
    {"emc_spindle", 0, 2, "[forward|reverse|increase|decrease|constant|off] [spindle]", spindle},
    {"emc_spindle_override", 0, 2, "[[spindle] percent]", spindle_override},
    {"emc_step", 0, 0, "", [](Shell &s, const Words &) { return s.ask("STEP"); }},
    {"emc_task_plan_init", 0, 0, "", [](Shell &s, const Words &) { return s.ask("TASK_PLAN_INIT"); }},
    {"emc_unhome", 1, 1, "joint|-1|-2", unhome},
};

}  // namespace

std::span<const CommandRow> orders() {
    return ROWS;
}

}  // namespace mw::tcl

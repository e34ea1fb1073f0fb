// SPDX-License-Identifier: GPL-2.0-or-later
#include "clients/rsh/answers.hh"

#include <unistd.h>

#include <array>
#include <chrono>
#include <cstdint>

#include <fmt/format.h>

#include "clients/rsh/axis_answers.hh"
#include "clients/rsh/units.hh"

namespace mw::rsh {
namespace {

using messages::MessageKind;

enum class SpokenBy : std::uint8_t { BOTH, NEWER, OLD };

struct Question {
    const char *name;
    SpokenBy dialect;
    Answering answering;
};

Answer line(std::string text) {
    return std::vector{std::move(text)};
}
Answer on_off(const char *name, bool isOn) {
    return line(fmt::format("{} {}", name, isOn ? "ON" : "OFF"));
}
/// What 2.9 tells by other words.
Answer flag(const Asked &asked, const char *name, bool isOn, const char *old_on, const char *old_off) {
    return asked.settings.isOld() ? line(fmt::format("{} {}", name, isOn ? old_on : old_off))
                                  : on_off(name, isOn);
}

Answer operator_line(const Asked &asked, const char *name, MessageKind kind) {
    const auto text = asked.shared.next_line(kind, asked.own.lines);
    // A line of the protocol is one line.
    std::string one = text.value_or("OK");
    for (char &c : one) {
        c = c == '\n' || c == '\r' ? ' ' : c;
    }
    return line(fmt::format("{} {}", name, one));
}

Answer ini_entry(const Asked &asked) {
    if (asked.words.size() < 2) {
        return fail("GET INI needs the name of an entry and of its section");
    }
    const std::string &key = asked.words[0], &section = asked.words[1];
    const ini::IniEntry *const entry =
        asked.settings.ini == nullptr ? nullptr : asked.settings.ini->find(section, key);
    if (entry == nullptr) {
        return fail(fmt::format("INI file entry '[{}]{}' not found", section, key));
    }
    return line(fmt::format("INI [{}]{}={}", section, key, entry->value));
}

std::string ini_path(const Settings &settings) {
    return settings.ini == nullptr ? "" : settings.ini->path();
}

Answer time(const Asked &) {
    const auto now = std::chrono::system_clock::now().time_since_epoch();
    return line(fmt::format("TIME {:.6f}", std::chrono::duration<double>(now).count()));
}

const char *mode_name(messages::Mode mode) {
    switch (mode) {
    case messages::Mode::MANUAL: return "MANUAL";
    case messages::Mode::AUTO: return "AUTO";
    case messages::Mode::MDI: break;
    }
    return "MDI";
}

Answer program_status(const Asked &asked) {
    switch (asked.status.task.interp_state) {
    case messages::InterpState::IDLE: return line("PROGRAM_STATUS IDLE");
    case messages::InterpState::PAUSED: return line("PROGRAM_STATUS PAUSED");
    case messages::InterpState::READING:
    case messages::InterpState::WAITING: break;
    }
    return line("PROGRAM_STATUS RUNNING");
}

Answer program(const Asked &asked) {
    const std::string path(asked.status.task.program.view());
    return line("PROGRAM " + (path.empty() ? "NONE" : path));
}

Answer program_codes(const Asked &asked) {
    std::string text = "PROGRAM_CODES";
    const auto &g = asked.status.codes.g;
    for (std::size_t i = 1; i < g.size(); ++i) {  // [0] is the number of the line
        if (g[i] >= 0) {
            text += g[i] % 10 == 0 ? fmt::format(" G{}", g[i] / 10)
                                   : fmt::format(" G{}.{}", g[i] / 10, g[i] % 10);
        }
    }
    return line(
        fmt::format("{} F{:g} S{:g}", text, asked.status.codes.settings[1], asked.status.codes.settings[2]));
}

Answer percent(const Asked &asked, const std::string &name, double factor) {
    return line(asked.settings.isOld() ? fmt::format("{} {:.0f}", name, factor * 100)
                                       : fmt::format("{} {:f}", name, factor * 100));
}

/// Of one spindle, the first without a number, or of all.
template <class Each>
Answer for_spindles(const Asked &asked, const Each &each) {
    const auto asked_for = asked.words.empty()
                               ? Result<int>(0)
                               : index_of(asked.words[0], "spindle", asked.settings.num_spindles);
    if (!asked_for.has_value()) {
        return std::unexpected(asked_for.error());
    }
    std::vector<std::string> lines;
    for (int i = 0; i < asked.settings.num_spindles; ++i) {
        if (*asked_for == -1 || *asked_for == i) {
            auto one = each(i, asked.status.spindles[static_cast<std::size_t>(i)]);
            lines.insert(lines.end(), one->begin(), one->end());
        }
    }
    return lines;
}

Answer spindle(const Asked &asked) {
    return for_spindles(asked, [](int i, const messages::SpindleStatus &spindle) {
        return line(fmt::format("SPINDLE {} {}", i,
                                spindle.direction > 0   ? "FORWARD"
                                : spindle.direction < 0 ? "REVERSE"
                                                        : "OFF"));
    });
}

Answer brake(const Asked &asked) {
    return for_spindles(asked, [&asked](int i, const messages::SpindleStatus &spindle) {
        const char *const state = spindle.isBrakeOn ? "ON" : "OFF";
        return line(asked.settings.isOld() ? fmt::format("BRAKE {}", state)
                                           : fmt::format("BRAKE {} {}", i, state));
    });
}

Answer spindle_override(const Asked &asked) {
    return for_spindles(asked, [&asked](int i, const messages::SpindleStatus &spindle) {
        return percent(asked, fmt::format("SPINDLE_OVERRIDE {}", i), spindle.override_factor);
    });
}

Answer probe_tripped(const Asked &asked) {
    const bool isTripped = asked.status.probe.isTripped;
    return line(asked.settings.isOld() ? fmt::format("PROBE_TRIPPED {}", isTripped ? 1 : 0)
                                       : fmt::format("PROBE_TRIPPED {}", isTripped ? "YES" : "NO"));
}

Answer debug(const Asked &asked) {
    const std::uint32_t mask = asked.status.settings.debug;
    return line(asked.settings.isOld() ? fmt::format("DEBUG {}", mask) : fmt::format("DEBUG 0x{:08x}", mask));
}

Answer wait_mode(const Asked &asked) {
    return line(fmt::format("{} {}", asked.settings.isOld() ? "SET_WAIT" : "WAIT_MODE",
                            asked.own.isWaitingForDone ? "DONE" : "RECEIVED"));
}

Answer timeout(const Asked &asked) {
    return line(
        fmt::format("{} {:f}", asked.settings.isOld() ? "SET_TIMEOUT" : "TIMEOUT", asked.own.timeout_s));
}

Answer tool_offset(const Asked &asked) {
    const double z = asked.status.offsets.tool[geometry::AXIS_Z] * length_factor(asked.own, asked.status);
    return line(fmt::format("TOOL_OFFSET {:f}", z));
}

constexpr SpokenBy BOTH = SpokenBy::BOTH, NEWER = SpokenBy::NEWER, OLD = SpokenBy::OLD;

/// In the order of the alphabet, as HELP lists them.
constexpr Question QUESTIONS[] = {
    {"ABS_ACT_POS", BOTH, absolute_actual},
    {"ABS_CMD_POS", BOTH, absolute_commanded},
    {"ANGULAR_UNIT_CONVERSION", BOTH,
     [](const Asked &a) {
         return line(fmt::format("ANGULAR_UNIT_CONVERSION {}", name_of(a.own.angle_unit)));
     }},
    {"AXIS_VELOCITY", NEWER, axis_velocity},
    {"BRAKE", BOTH, brake},
    {"CLIENTS", NEWER, [](const Asked &a) { return line(fmt::format("CLIENTS {}", a.shared.num_sessions)); }},
    {"COMM_MODE", BOTH, [](const Asked &) { return line("COMM_MODE ASCII"); }},
    {"COMM_PROT", BOTH, [](const Asked &a) { return line("COMM_PROT " + a.own.protocol); }},
    {"CONFIG", OLD, [](const Asked &) { return line("CONFIG"); }},
    {"DEBUG", BOTH, debug},
    {"DISPLAY_ANGULAR_UNITS", BOTH,
     [](const Asked &a) {
         return line(fmt::format("DISPLAY_ANGULAR_UNITS {}",
                                 a.own.angle_unit == AngleUnit::AUTO ? "DEG" : name_of(a.own.angle_unit)));
     }},
    {"DISPLAY_LINEAR_UNITS", BOTH,
     [](const Asked &a) {
         return line(fmt::format("DISPLAY_LINEAR_UNITS {}", name_of(shown_unit(a.own, a.status))));
     }},
    {"ECHO", BOTH, [](const Asked &a) { return on_off("ECHO", a.own.isEchoing); }},
    {"ENABLE", BOTH, [](const Asked &a) { return on_off("ENABLE", a.own.isEnabled); }},
    {"ERROR", BOTH, [](const Asked &a) { return operator_line(a, "ERROR", MessageKind::OPERATOR_ERROR); }},
    {"ESTOP", BOTH,
     [](const Asked &a) { return on_off("ESTOP", a.status.task.state == messages::State::ESTOP); }},
    {"FEED_OVERRIDE", BOTH,
     [](const Asked &a) { return percent(a, "FEED_OVERRIDE", a.status.overrides.feed); }},
    {"FLOOD", BOTH, [](const Asked &a) { return on_off("FLOOD", a.status.io.coolant.isFloodOn); }},
    {"INI", NEWER, ini_entry},
    {"INIFILE", BOTH, [](const Asked &a) { return line("INIFILE " + ini_path(a.settings)); }},
    {"JOINT_FAULT", BOTH, joint_fault},
    {"JOINT_HOMED", BOTH, joint_homed},
    {"JOINT_LIMIT", BOTH, joint_limit},
    {"JOINT_POS", BOTH, joint_position},
    {"JOINT_TYPE", BOTH, joint_type},
    {"JOINT_UNITS", BOTH, joint_units},
    {"JOINT_VELOCITY", NEWER, joint_velocity},
    {"KINEMATICS_TYPE", BOTH,
     [](const Asked &a) {
         return line(fmt::format("KINEMATICS_TYPE {}", static_cast<int>(a.status.settings.kinematics)));
     }},
    {"LINEAR_UNIT_CONVERSION", BOTH,
     [](const Asked &a) {
         return line(fmt::format("LINEAR_UNIT_CONVERSION {}", name_of(a.own.length_unit)));
     }},
    {"LUBE", BOTH, [](const Asked &a) { return on_off("LUBE", a.status.io.lube.isOn); }},
    {"LUBE_LEVEL", BOTH,
     [](const Asked &a) { return line(a.status.io.lube.hasOil ? "LUBE_LEVEL OK" : "LUBE_LEVEL LOW"); }},
    {"MACHINE", BOTH,
     [](const Asked &a) { return on_off("MACHINE", a.status.task.state == messages::State::ON); }},
    {"MIST", BOTH, [](const Asked &a) { return on_off("MIST", a.status.io.coolant.isMistOn); }},
    {"MODE", BOTH,
     [](const Asked &a) { return line(fmt::format("MODE {}", mode_name(a.status.task.mode))); }},
    {"OPEN", NEWER, program},
    {"OPERATOR_DISPLAY", BOTH,
     [](const Asked &a) { return operator_line(a, "OPERATOR_DISPLAY", MessageKind::OPERATOR_DISPLAY); }},
    {"OPERATOR_TEXT", BOTH,
     [](const Asked &a) { return operator_line(a, "OPERATOR_TEXT", MessageKind::OPERATOR_TEXT); }},
    {"OPTIONAL_STOP", BOTH,
     [](const Asked &a) { return flag(a, "OPTIONAL_STOP", a.status.task.isOptionalStop, "1", "0"); }},
    {"OVERRIDE_LIMITS", BOTH,
     [](const Asked &a) {
         return flag(a, "OVERRIDE_LIMITS", a.status.joints[0].isOverridingLimits, "1", "0");
     }},
    {"PLAT", BOTH, [](const Asked &) { return line("PLAT Linux"); }},
    {"POS_OFFSET", BOTH, position_offset},
    {"PROBE_TRIPPED", BOTH, probe_tripped},
    {"PROBE_VALUE", BOTH,
     [](const Asked &a) { return line(a.status.probe.isOn ? "PROBE_VALUE 1" : "PROBE_VALUE 0"); }},
    {"PROGRAM", BOTH, program},
    {"PROGRAM_ANGULAR_UNITS", BOTH, [](const Asked &) { return line("PROGRAM_ANGULAR_UNITS DEG"); }},
    {"PROGRAM_CODES", BOTH, program_codes},
    {"PROGRAM_LINE", BOTH,
     [](const Asked &a) { return line(fmt::format("PROGRAM_LINE {}", a.status.task.motion_line)); }},
    {"PROGRAM_LINEAR_UNITS", BOTH,
     [](const Asked &a) { return line(fmt::format("PROGRAM_UNITS {}", name_of(program_unit(a.status)))); }},
    {"PROGRAM_STATUS", BOTH, program_status},
    {"PROGRAM_UNITS", BOTH,
     [](const Asked &a) { return line(fmt::format("PROGRAM_UNITS {}", name_of(program_unit(a.status)))); }},
    {"REL_ACT_POS", BOTH, relative_actual},
    {"REL_CMD_POS", BOTH, relative_commanded},
    {"SET_WAIT", OLD, wait_mode},
    {"SPINDLE", BOTH, spindle},
    {"SPINDLE_OVERRIDE", BOTH, spindle_override},
    {"TELEOP_ENABLE", BOTH,
     [](const Asked &a) {
         return flag(a, "TELEOP_ENABLE", a.status.trajectory.mode == messages::MotionMode::TELEOP, "YES",
                     "NO");
     }},
    {"TIME", BOTH, time},
    {"TIMEOUT", BOTH, timeout},
    {"TIMESTAMP", NEWER, [](const Asked &a) { return on_off("TIMESTAMP", a.own.isTimed); }},
    {"TOOL", BOTH, [](const Asked &a) { return line(fmt::format("TOOL {}", a.status.tool.in_spindle)); }},
    {"TOOL_OFFSET", BOTH, tool_offset},
    {"UPDATE", BOTH, [](const Asked &a) { return line(a.own.isUpdating ? "UPDATE AUTO" : "UPDATE NONE"); }},
    {"USER_ANGULAR_UNITS", BOTH,
     [](const Asked &a) {
         return line("USER_ANGULAR_UNITS " + name_of_angle(a.status.settings.angular_units));
     }},
    {"USER_LINEAR_UNITS", BOTH,
     [](const Asked &a) {
         return line("USER_LINEAR_UNITS " + name_of_length(a.status.settings.linear_units));
     }},
    {"VERBOSE", BOTH, [](const Asked &a) { return on_off("VERBOSE", a.own.isVerbose); }},
    {"WAIT_MODE", NEWER, wait_mode},
};

bool isSpoken(const Question &question, const Settings &settings) {
    return question.dialect != (settings.isOld() ? NEWER : OLD);
}

}  // namespace

Answering answering(const Settings &settings, const std::string &name) {
    for (const Question &question : QUESTIONS) {
        if (question.name == name && isSpoken(question, settings)) {
            return question.answering;
        }
    }
    return nullptr;
}

std::vector<std::string> question_names(const Settings &settings) {
    std::vector<std::string> names;
    for (const Question &question : QUESTIONS) {
        if (isSpoken(question, settings)) {
            names.emplace_back(question.name);
        }
    }
    return names;
}

}  // namespace mw::rsh

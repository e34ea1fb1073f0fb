// SPDX-License-Identifier: GPL-2.0-or-later
#include "clients/rsh/answers.hh"

#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <string_view>

#include <fmt/format.h>

#include "clients/rsh/axis_answers.hh"
#include "clients/rsh/units.hh"
#include "messages/legacy/units.hh"

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
Answer on_off(const char *name, bool on) {
    return line(fmt::format("{} {}", name, on ? "ON" : "OFF"));
}
Answer operator_line(const Asked &asked, const char *name, MessageKind kind) {
    const auto text = asked.shared.next_line(kind, asked.own.lines);
    // An answer of the protocol has one line.
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

Answer program_status(const Asked &asked) {
    switch (asked.status.task.interp_state) {
    case messages::InterpState::IDLE: return line("PROGRAM_STATUS IDLE");
    case messages::InterpState::PAUSED: return line("PROGRAM_STATUS PAUSED");
    case messages::InterpState::READING:
    case messages::InterpState::WAITING: break;
    }
    return line("PROGRAM_STATUS RUNNING");
}

/// GET PROGRAM, which newer versions also call OPEN.
Answer program(const Asked &asked) {
    return line("PROGRAM " +
                legacy::text(legacy::Form::PATH, dialect(asked), asked.status.task.program.str()));
}

Answer program_codes(const Asked &asked) {
    std::string text = "PROGRAM_CODES";
    const auto &g = asked.status.codes.g;
    for (std::size_t i = 1; i < g.size(); ++i) {  // [0] is the line number
        if (g[i] >= 0) {
            text += g[i] % 10 == 0 ? fmt::format(" G{}", g[i] / 10)
                                   : fmt::format(" G{}.{}", g[i] / 10, g[i] % 10);
        }
    }
    return line(
        fmt::format("{} F{:g} S{:g}", text, asked.status.codes.settings[1], asked.status.codes.settings[2]));
}

/// The answer for one spindle (the first one without a number), or for all.
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

Answer brake(const Asked &asked) {
    return for_spindles(asked, [&asked](int i, const messages::SpindleStatus &spindle) {
        const char *const state = spindle.isBrakeOn ? "ON" : "OFF";
        return line(asked.settings.isOld() ? fmt::format("BRAKE {}", state)
                                           : fmt::format("BRAKE {} {}", i, state));
    });
}

Answer wait_mode(const Asked &asked) {
    return line(fmt::format("{} {}", asked.settings.isOld() ? "SET_WAIT" : "WAIT_MODE",
                            asked.own.waiting_for_done ? "DONE" : "RECEIVED"));
}

Answer timeout(const Asked &asked) {
    return line(
        fmt::format("{} {:f}", asked.settings.isOld() ? "SET_TIMEOUT" : "TIMEOUT", asked.own.timeout_s));
}

Answer tool_offset(const Asked &asked) {
    const double z =
        asked.status.offsets.tool[geometry::AXIS_Z] * length_factor(asked.own.length_unit, asked.status);
    return line(fmt::format("TOOL_OFFSET {:f}", z));
}

/// Answers from a row of the status table.
template <std::size_t I>
Answer status_answer(const Asked &asked) {
    constexpr const auto &ROW = std::get<I>(legacy::STATUS);
    const auto value = ROW.get(asked.status);
    if constexpr (ROW.form == legacy::Form::POSE) {
        return pose(asked, ROW.names.rsh, value);
    } else {
        return line(fmt::format("{} {}", ROW.names.rsh, legacy::text(ROW.form, dialect(asked), value)));
    }
}
template <std::size_t I>
Answer spindle_answer(const Asked &asked) {
    constexpr const auto &ROW = std::get<I>(legacy::SPINDLE_STATUS);
    return for_spindles(asked, [&asked](int i, const messages::SpindleStatus &spindle) {
        return line(fmt::format("{} {} {}", ROW.names.rsh, i,
                                legacy::text(ROW.form, dialect(asked), ROW.get(spindle))));
    });
}

constexpr SpokenBy BOTH = SpokenBy::BOTH, NEWER = SpokenBy::NEWER, OLD = SpokenBy::OLD;

/// State of the connection, and values that other clients do not read in this form.
constexpr Question QUESTIONS[] = {
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
    {"INI", NEWER, ini_entry},
    {"INIFILE", BOTH, [](const Asked &a) { return line("INIFILE " + ini_path(a.settings)); }},
    {"LINEAR_UNIT_CONVERSION", BOTH,
     [](const Asked &a) {
         return line(fmt::format("LINEAR_UNIT_CONVERSION {}", name_of(a.own.length_unit)));
     }},
    {"JOINT_VELOCITY", NEWER, joint_velocity},
    {"OPEN", NEWER, program},
    {"OPERATOR_DISPLAY", BOTH,
     [](const Asked &a) { return operator_line(a, "OPERATOR_DISPLAY", MessageKind::OPERATOR_DISPLAY); }},
    {"OPERATOR_TEXT", BOTH,
     [](const Asked &a) { return operator_line(a, "OPERATOR_TEXT", MessageKind::OPERATOR_TEXT); }},
    {"PLAT", BOTH, [](const Asked &) { return line("PLAT Linux"); }},
    {"POS_OFFSET", BOTH, position_offset},
    {"PROGRAM_ANGULAR_UNITS", BOTH, [](const Asked &) { return line("PROGRAM_ANGULAR_UNITS DEG"); }},
    {"PROGRAM_CODES", BOTH, program_codes},
    {"PROGRAM_LINEAR_UNITS", BOTH,
     [](const Asked &a) { return line(fmt::format("PROGRAM_UNITS {}", name_of(program_unit(a.status)))); }},
    {"PROGRAM_STATUS", BOTH, program_status},
    {"PROGRAM_UNITS", BOTH,
     [](const Asked &a) { return line(fmt::format("PROGRAM_UNITS {}", name_of(program_unit(a.status)))); }},
    {"SET_WAIT", OLD, wait_mode},
    {"TIME", BOTH, time},
    {"TIMEOUT", BOTH, timeout},
    {"TIMESTAMP", NEWER, [](const Asked &a) { return on_off("TIMESTAMP", a.own.isTimed); }},
    {"TOOL_OFFSET", BOTH, tool_offset},
    {"UPDATE", BOTH, [](const Asked &a) { return line(a.own.updating ? "UPDATE AUTO" : "UPDATE NONE"); }},
    {"USER_ANGULAR_UNITS", BOTH,
     [](const Asked &a) {
         return line("USER_ANGULAR_UNITS " + legacy::name_of_angle(a.status.settings.angular_units));
     }},
    {"USER_LINEAR_UNITS", BOTH,
     [](const Asked &a) {
         return line("USER_LINEAR_UNITS " + legacy::name_of_length(a.status.settings.linear_units));
     }},
    {"VERBOSE", BOTH, [](const Asked &a) { return on_off("VERBOSE", a.own.isVerbose); }},
    {"WAIT_MODE", NEWER, wait_mode},
};

constexpr auto OF_STATUS = legacy::from_rows<legacy::STATUS, &legacy::Names::rsh>(
    []<std::size_t I>() { return Question{std::get<I>(legacy::STATUS).names.rsh, BOTH, status_answer<I>}; });
constexpr auto OF_SPINDLES =
    legacy::from_rows<legacy::SPINDLE_STATUS, &legacy::Names::rsh>([]<std::size_t I>() {
        return Question{std::get<I>(legacy::SPINDLE_STATUS).names.rsh, BOTH, spindle_answer<I>};
    });

/// All questions in alphabetical order, as HELP lists them.
const std::vector<Question> &questions() {
    static const std::vector<Question> ALL = [] {
        std::vector<Question> all(std::begin(QUESTIONS), std::end(QUESTIONS));
        all.insert(all.end(), OF_STATUS.begin(), OF_STATUS.end());
        all.insert(all.end(), OF_SPINDLES.begin(), OF_SPINDLES.end());
        for (const auto &[name, answering] : joint_answers()) {
            all.push_back({name, BOTH, answering});
        }
        std::ranges::sort(all, {}, [](const Question &one) { return std::string_view(one.name); });
        return all;
    }();
    return ALL;
}

bool isSpoken(const Question &question, const Settings &settings) {
    return question.dialect != (settings.isOld() ? NEWER : OLD);
}

}  // namespace

Answering answering(const Settings &settings, const std::string &name) {
    for (const Question &question : questions()) {
        if (question.name == name && isSpoken(question, settings)) {
            return question.answering;
        }
    }
    return nullptr;
}

std::vector<std::string> question_names(const Settings &settings) {
    std::vector<std::string> names;
    for (const Question &question : questions()) {
        if (isSpoken(question, settings)) {
            names.emplace_back(question.name);
        }
    }
    return names;
}

}  // namespace mw::rsh

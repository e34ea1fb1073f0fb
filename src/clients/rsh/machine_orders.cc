// SPDX-License-Identifier: GPL-2.0-or-later
#include "clients/rsh/machine_orders.hh"

#include <filesystem>

#include <fmt/format.h>

#include "base/text.hh"
#include "clients/nml/message/wire_table.hh"
#include "messages/legacy/units.hh"

namespace mw::rsh {
namespace {

/// Speed of a spindle without a programmed speed. [rev/min]
constexpr double PRESET_SPEED = 500;

const char *phrase(messages::Mode mode) {
    switch (mode) {
    case messages::Mode::MANUAL: return "manual mode";
    case messages::Mode::AUTO: return "auto mode";
    case messages::Mode::MDI: break;
    }
    return "MDI mode";
}

template <class On, class Off>
Result<Waiting> toggle(const Ordered &o, const On &on, const Off &off) {
    const auto isOn = on_or_off(word(o, 0));
    if (!isOn.has_value()) {
        return std::unexpected(isOn.error());
    }
    return ask(o, *isOn ? messages::Command(on) : messages::Command(off));
}

/// Posts the command from `make` for one spindle, or for all with -1.
template <class Make>
Result<Waiting> for_spindles(const Ordered &o, int spindle, const Make &make) {
    Waiting waiting;
    for (int i = 0; i < o.settings.num_spindles; ++i) {
        if (spindle != -1 && spindle != i) {
            continue;
        }
        auto asked = ask(o, make(i));
        if (!asked.has_value()) {
            return asked;
        }
        waiting.serials.push_back(asked->serials.front());
    }
    return waiting;
}

/// The number at an index; `preset` if it is missing.
Result<int> spindle_at(const Ordered &o, std::size_t place, int preset) {
    return o.words.size() > place ? index_of(o.words[place], "spindle", o.settings.num_spindles)
                                  : Result<int>(preset);
}

bool isWrongMode(const Ordered &o, messages::Mode wanted, const messages::Declaration &what) {
    if (o.status().task.mode == wanted) {
        return false;
    }
    tell_wrong_mode(o, what);
    return true;
}

}  // namespace

std::string word(const Ordered &o, std::size_t place) {
    return o.words.size() > place ? o.words[place] : std::string();
}

Result<Waiting> ask(const Ordered &o, const messages::Command &command, Until until) {
    const auto serial = o.commander.post(command);
    if (!serial.has_value()) {
        return std::unexpected(serial.error());
    }
    return Waiting{until, {*serial}, {}, false};
}

void tell_wrong_mode(const Ordered &o, const messages::Declaration &what) {
    std::string name(nml::wire_name(what));
    name.resize(name.size() - std::string_view("_TYPE").size());
    o.errors.push_back(
        fmt::format("can't do that ({}:{}) in {}", name, what.number, phrase(o.status().task.mode)));
}

Result<Waiting> abort_all(const Ordered &o) {
    return ask(o, messages::AbortAll{});
}

Result<Waiting> set_debug(const Ordered &o) {
    const auto bits = parse_uint(word(o, 0));
    if (!bits.has_value() || *bits > UINT32_MAX) {
        return no_such_value(word(o, 0), "a number of 32 bits");
    }
    return ask(o, messages::SetDebug{static_cast<std::uint32_t>(*bits)});
}

Result<Waiting> set_estop(const Ordered &o) {
    return toggle(o, messages::SetState{messages::State::ESTOP},
                  messages::SetState{messages::State::ESTOP_RESET});
}

Result<Waiting> set_machine(const Ordered &o) {
    return toggle(o, messages::SetState{messages::State::ON}, messages::SetState{messages::State::OFF});
}

Result<Waiting> set_mode(const Ordered &o) {
    const auto mode = one_of<messages::Mode>(
        word(o, 0),
        {{"MANUAL", messages::Mode::MANUAL}, {"AUTO", messages::Mode::AUTO}, {"MDI", messages::Mode::MDI}});
    return mode.has_value() ? ask(o, messages::SetMode{*mode}) : std::unexpected(mode.error());
}

Result<Waiting> mdi(const Ordered &o) {
    if (o.rest.empty()) {
        return fail("SET MDI needs a line of G-code");
    }
    return ask(o, messages::Mdi{o.rest});
}

Result<Waiting> open_program(const Ordered &o) {
    if (o.rest.empty()) {
        return fail("SET OPEN needs the name of a file");
    }
    std::filesystem::path path(o.rest);
    if (path.is_relative()) {
        const std::string folder = !o.settings.program_folder.empty() ? o.settings.program_folder
                                   : o.settings.ini != nullptr        ? o.settings.ini->folder()
                                                                      : ".";
        std::error_code error;
        path = std::filesystem::absolute(std::filesystem::path(folder) / path, error).lexically_normal();
    }
    return ask(o, messages::OpenProgram{path.string()});
}

Result<Waiting> run(const Ordered &o) {
    const auto line = parse_int(o.words.empty() ? "0" : o.words[0]);
    if (!line.has_value() || *line < -1 || *line > INT32_MAX) {
        return no_such_value(word(o, 0), "the number of a line, -1 to verify");
    }
    return ask(o, messages::RunProgram{static_cast<int>(*line)});
}

Result<Waiting> pause(const Ordered &o) {
    // Clients also send a pause when nothing runs; this is not an error.
    return o.status().task.interp_state == messages::InterpState::IDLE ? Waiting{}
                                                                       : ask(o, messages::PauseProgram{});
}

Result<Waiting> resume(const Ordered &o) {
    return o.status().task.isPaused ? ask(o, messages::ResumeProgram{}) : Waiting{};
}

Result<Waiting> step(const Ordered &o) {
    if (isWrongMode(o, messages::Mode::AUTO, messages::DECLARATION<messages::StepProgram>)) {
        // LinuxCNC 2.9 only reports that the order was received
        return o.settings.isOld() ? Result<Waiting>(Waiting{}) : fail("");
    }
    return ask(o, messages::StepProgram{}, Until::TAKEN);
}

Result<Waiting> reset_interpreter(const Ordered &o) {
    return ask(o, messages::ResetInterpreter{});
}

Result<Waiting> set_optional_stop(const Ordered &o) {
    const auto isOn =
        word(o, 0).empty() || isSameWord(word(o, 0), "NONE") ? Result<bool>(false) : on_or_off(word(o, 0));
    return isOn.has_value() ? ask(o, messages::SetOptionalStop{*isOn}) : std::unexpected(isOn.error());
}

Result<Waiting> set_flood(const Ordered &o) {
    return toggle(o, messages::FloodOn{}, messages::FloodOff{});
}
Result<Waiting> set_mist(const Ordered &o) {
    return toggle(o, messages::MistOn{}, messages::MistOff{});
}
Result<Waiting> set_lube(const Ordered &o) {
    return toggle(o, messages::LubeOn{}, messages::LubeOff{});
}

Result<Waiting> set_spindle(const Ordered &o) {
    enum class Turn : std::uint8_t { FORWARD, REVERSE, INCREASE, DECREASE, CONSTANT, OFF };
    const bool is_off = isSameWord(word(o, 0), "OFF");
    // Without a number one spindle is started, but all are stopped.
    const auto spindle = spindle_at(o, 1, is_off ? -1 : 0);
    if (!spindle.has_value()) {
        return std::unexpected(spindle.error());
    }
    const auto turn = one_of<Turn>(word(o, 0), {{"FORWARD", Turn::FORWARD},
                                                {"REVERSE", Turn::REVERSE},
                                                {"INCREASE", Turn::INCREASE},
                                                {"DECREASE", Turn::DECREASE},
                                                {"CONSTANT", Turn::CONSTANT},
                                                {"OFF", Turn::OFF}});
    if (!turn.has_value()) {
        return std::unexpected(turn.error());
    }
    constexpr std::size_t S = 2;  // index in the settings
    const double programmed = o.status().codes.settings[S];
    const double speed = programmed > 0 ? programmed : PRESET_SPEED;
    return for_spindles(o, *spindle, [&](int i) -> messages::Command {
        switch (*turn) {
        case Turn::FORWARD: return messages::SpindleOn{i, speed};
        case Turn::REVERSE: return messages::SpindleOn{i, -speed};
        case Turn::INCREASE: return messages::SpindleIncrease{i};
        case Turn::DECREASE: return messages::SpindleDecrease{i};
        case Turn::CONSTANT: return messages::SpindleConstant{i};
        case Turn::OFF: break;
        }
        return messages::SpindleOff{i};
    });
}

Result<Waiting> set_brake(const Ordered &o) {
    const auto spindle = spindle_at(o, 1, 0);
    if (!spindle.has_value()) {
        return std::unexpected(spindle.error());
    }
    const auto isOn = on_or_off(word(o, 0));
    if (!isOn.has_value()) {
        return std::unexpected(isOn.error());
    }
    return for_spindles(o, *spindle, [&](int i) {
        return *isOn ? messages::Command(messages::EngageBrake{i})
                     : messages::Command(messages::ReleaseBrake{i});
    });
}

Result<Waiting> set_spindle_override(const Ordered &o) {
    const bool numbered = o.words.size() > 1;
    const auto spindle = numbered ? index_of(o.words[0], "spindle", o.settings.num_spindles) : Result<int>(0);
    if (!spindle.has_value()) {
        return std::unexpected(spindle.error());
    }
    const auto percent = number(word(o, numbered ? 1 : 0), "percentage");
    if (!percent.has_value()) {
        return std::unexpected(percent.error());
    }
    return for_spindles(o, *spindle,
                        [&](int i) { return messages::SetSpindleOverride{legacy::factor(*percent), i}; });
}

Result<Waiting> load_tool_table(const Ordered &o) {
    // The machine has only the table that its INI file names.
    const ini::IniEntry *const entry =
        o.settings.ini == nullptr ? nullptr : o.settings.ini->find("EMCIO", "TOOL_TABLE");
    const std::filesystem::path own(entry == nullptr ? "" : entry->value);
    if (!o.rest.empty() && std::filesystem::path(o.rest).filename() != own.filename()) {
        return fail(fmt::format("the machine's tool table is '{}'", own.string()));
    }
    return ask(o, messages::LoadToolTable{});
}

Result<Waiting> set_tool_offset(const Ordered &o) {
    const auto tool = parse_int(word(o, 0));
    const auto length = number(word(o, 1), "length"), diameter = number(word(o, 2), "diameter");
    if (!tool.has_value() || *tool < 0 || *tool > INT32_MAX) {
        return no_such_value(word(o, 0), "the number of a tool");
    }
    if (!length.has_value() || !diameter.has_value()) {
        return std::unexpected(length.has_value() ? diameter.error() : length.error());
    }
    messages::SetToolEntry entry;
    entry.toolno = static_cast<int>(*tool);
    entry.offset[geometry::AXIS_Z] = *length;
    entry.diameter = *diameter;
    return ask(o, entry);
}

}  // namespace mw::rsh

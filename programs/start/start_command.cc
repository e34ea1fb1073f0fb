// SPDX-License-Identifier: GPL-2.0-or-later
// millwright start: a machine that runs until a signal arrives or its display ends; clients run programs on
// it.
#include <cstdio>

#include <fmt/format.h>

#include "base/language/language.hh"
#include "base/options/command_line.hh"
#include "base/stop_signals.hh"
#include "machine/config/loaded_config.hh"
#include "programs/command_words.hh"
#include "programs/commands.hh"
#include "programs/start/machine_start.hh"

namespace mw::programs {
namespace {

struct StartWords {
    std::string ini, homing_module, planner_module;
    bool displayed = true, strict = false;
    options::Words rest;

    options::CommandLine line() {
        options::CommandLine line(
            "millwright start MACHINE.ini [options]",
            "Starts the machine in real time, in emergency stop, and keeps it running for its clients: "
            "'millwright run\nMACHINE.ini PROGRAM.ngc --realtime' then runs programs on it, one after the "
            "other. It ends when the\ndisplay of [DISPLAY]DISPLAY ends, or at SIGINT, SIGTERM, SIGHUP or "
            "SIGQUIT: all axes stop along the\npath, spindles, coolant and the machine are switched off, "
            "parameters are saved. A second SIGINT ends it\nat once.\n");
        line.flag("--no-display", "start no display: run until a signal ends it", displayed, false);
        line.text("--homemod", "NAME", "a homing module and its parameters, instead of [EMCMOT]HOMEMOD",
                  homing_module);
        line.text("--tpmod", "NAME", "a planner module and its parameters, instead of [TRAJ]TPMOD",
                  planner_module);
        line.flag("--strict", "unknown INI keys are errors", strict);
        line.rest(rest);
        line.footer(
            "exit status: 0 normal end, or that of the display; 1 rejected or failed, 2 wrong usage\n");
        return line;
    }
    Result<> parse(const std::vector<std::string> &words) {
        const auto parsed = line().parse(words);
        if (parsed.has_value() && rest.size() != 1) {
            return fail("start needs a machine's INI file", {}, "millwright start MACHINE.ini");
        }
        ini = parsed.has_value() ? rest[0] : "";
        return parsed;
    }
};

}  // namespace

int command_start(const std::vector<std::string> &arguments) {
    StartWords words;
    if (const auto ended = ended_by_words("start", words, arguments)) {
        return *ended;
    }
    catch_stop_signals();
    diagnostics::Sink sink = standard_error_sink();
    auto loaded = machine::LoadedConfig::load(words.ini, sink);
    if (loaded == nullptr) {
        return 1;
    }
    StartSettings settings;
    settings.ini = words.ini;
    settings.displayed = words.displayed;
    settings.options.strict = words.strict;
    settings.options.homing_module = words.homing_module;
    settings.options.planner_module = words.planner_module;
    return MachineStart(settings, *loaded, sink).run();
}

}  // namespace mw::programs

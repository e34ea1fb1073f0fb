// SPDX-License-Identifier: GPL-2.0-or-later
// millwright check: interprets a program for a machine and checks its moves without motion.
#include <cstdio>
#include <optional>

#include <fmt/format.h>

#include "base/language/language.hh"
#include "base/options/command_line.hh"
#include "base/stop_signals.hh"
#include "gcode/analysis/program_check.hh"
#include "machine/config/ini_parameters.hh"
#include "machine/config/loaded_config.hh"
#include "machine/config/program_analysis.hh"
#include "machine/tools/tool_data.hh"
#include "programs/command_words.hh"
#include "programs/commands.hh"
#include "programs/run/plot.hh"
#include "programs/run/progress_line.hh"
#include "programs/run/time_report.hh"

namespace mw::programs {
namespace {

void print_result(const std::string &program, const machine::MachineConfig &machine,
                  const gcode::CheckResult &result) {
    const char *unit = machine.metric ? "mm" : "in";
    fmt::print("{}: {} blocks, {} moves, cutting {:.3f} {}, rapid {:.3f} {}\n", program, result.blocks,
               result.moves, result.cutting_length, unit, result.rapid_length, unit);
    for (int axis = 0; axis < MAX_AXES && result.has_moves; ++axis) {
        const auto i = static_cast<std::size_t>(axis);
        if ((machine.axis_mask & (1U << axis)) != 0) {
            fmt::print("  {} from {:.4f} to {:.4f} {} of the machine\n", geometry::AXIS_LETTERS[axis],
                       result.lowest[i], result.highest[i], geometry::isAngular(axis) ? "deg" : unit);
        }
    }
}

struct CheckWords {
    std::string program, ini, plot;
    std::int64_t bound = -1;
    options::Words rest;

    options::CommandLine line() {
        options::CommandLine line(
            "millwright check PROGRAM.ngc --ini MACHINE.ini [options]",
            "Interprets the program for the machine and checks its moves against the limits. Nothing moves. "
            "Prints the\nextents in machine coordinates and the time that the planner expects.\n");
        line.text("--ini", "MACHINE.ini", "the machine", ini);
        line.text("--plot", "FILE", "draw the tool path, as .png or .svg", plot);
        line.number("--statements", "N", "maximum number of statements of a loop (0: no limit)", bound, 0,
                    INT64_MAX);
        line.rest(rest);
        line.footer("exit status: 0 no error, 1 errors, 2 wrong usage\n");
        return line;
    }
    std::optional<std::int64_t> statements() const { return bound < 0 ? std::nullopt : std::optional(bound); }
};

int check_loaded(const CheckWords &words, const machine::LoadedConfig &loaded, gcode::ToolSource &tools,
                 diagnostics::Sink &sink) {
    machine::IniParameters values(loaded.ini, nullptr);
    ProgressLine progress;
    gcode::PathPoints points;
    gcode::CheckOptions check;
    check.statements = words.statements();
    check.points = words.plot.empty() ? nullptr : &points;
    check.progress = [&progress](const gcode::PreviewProgress &now) {
        progress.show(now);
        return stop_signal == 0;
    };
    const gcode::CheckResult result = gcode::check_program(machine::checked_machine(loaded.machine),
                                                           words.program, {tools, values}, sink, check);
    progress.clear();
    if (result.cancelled) {
        sink.error("stopped by " + stop_signal_name());
    }
    if (!words.plot.empty() && result.has_moves) {
        const auto drawn = plot_path(points.all(), loaded.machine, words.program, words.plot);
        if (!drawn.has_value()) {
            sink.error(drawn.error());
        }
    }
    if (sink.hasErrors()) {
        fmt::print(stderr, "{}: {} error(s)\n", words.program, sink.count_errors());
        return 1;
    }
    print_result(words.program, loaded.machine, result);
    if (result.time.has_value()) {
        print_times(*result.time);
    }
    return 0;
}

}  // namespace

int command_check(const std::vector<std::string> &arguments) {
    CheckWords words;
    if (options::wantsHelp(arguments)) {
        fmt::print("{}", words.line().help());
        return 0;
    }
    const auto parsed = words.line().parse(arguments);
    if (!parsed.has_value()) {
        fmt::print(stderr, "millwright check: {}\n", language::shown(parsed.error().str()));
        return 2;
    }
    if (words.rest.size() != 1 || words.ini.empty()) {
        fmt::print(stderr, "millwright check: needs a program and a machine: millwright check PROGRAM.ngc "
                           "--ini MACHINE.ini\n");
        return 2;
    }
    words.program = words.rest[0];
    catch_stop_signals();
    diagnostics::Sink sink = standard_error_sink();
    const auto drawable = words.plot.empty() ? Result<>{} : check_picture(words.plot);
    if (!drawable.has_value()) {
        sink.error(drawable.error());
        return 1;
    }
    const auto loaded = machine::LoadedConfig::load(words.ini, sink);
    if (loaded == nullptr) {
        return 1;
    }
    auto tools = machine::read_tools(loaded->machine, sink);
    if (!tools.has_value()) {
        sink.error(tools.error());
        return 1;
    }
    return check_loaded(words, *loaded, **tools, sink);
}

}  // namespace mw::programs

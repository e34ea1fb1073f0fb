// SPDX-License-Identifier: GPL-2.0-or-later
// millwright check: interprets a program for a machine and checks its moves, moving nothing.
#include <cstdio>
#include <optional>

#include <fmt/format.h>

#include "app/commands.hh"
#include "app/options.hh"
#include "app/plot.hh"
#include "app/progress_line.hh"
#include "app/time_report.hh"
#include "base/stop_signals.hh"
#include "base/text.hh"
#include "machine/ini_parameters.hh"
#include "machine/loaded_config.hh"
#include "machine/program_check.hh"
#include "machine/tool_file.hh"

namespace mw::app {
namespace {

constexpr const char *USAGE = "usage: millwright check PROGRAM.ngc --ini MACHINE.ini [options]\n"
                              "\n"
                              "Interprets the program for the machine and checks its moves against the "
                              "limits, moving nothing. Prints the\n"
                              "extents in machine coordinates, and the time that the planner expects.\n"
                              "\n"
                              "  --plot FILE       draw the tool path, as .png or .svg\n"
                              "  --statements N    a loop may take N statements, 0: any number\n"
                              "\n"
                              "exit status: 0 no error, 1 errors, 2 wrong usage\n";

void print_result(const std::string &program, const machine::MachineConfig &machine,
                  const machine::CheckResult &result) {
    const char *unit = machine.isMetric ? "mm" : "in";
    fmt::print("{}: {} blocks, {} moves, cutting {:.3f} {}, rapid {:.3f} {}\n", program, result.blocks,
               result.moves, result.cutting_length, unit, result.rapid_length, unit);
    for (int axis = 0; axis < MAX_AXES && result.hasMoves; ++axis) {
        const auto i = static_cast<std::size_t>(axis);
        if ((machine.axis_mask & (1U << axis)) != 0) {
            fmt::print("  {} from {:.4f} to {:.4f} {} of the machine\n", geom::AXIS_LETTERS[axis],
                       result.lowest[i], result.highest[i], geom::isAngular(axis) ? "deg" : unit);
        }
    }
}

struct CheckWords {
    std::string program, plot;
    std::optional<std::int64_t> statements;
};

int check_loaded(const CheckWords &words, const machine::LoadedConfig &loaded, machine::ToolFile &tools,
                 diag::Sink &sink) {
    machine::IniParameters values(loaded.ini, nullptr);
    ProgressLine progress;
    machine::PathPoints points;
    machine::CheckOptions check;
    check.statements = words.statements;
    check.points = words.plot.empty() ? nullptr : &points;
    check.progress = [&progress](const gcode::PreviewProgress &now) {
        progress.show(now);
        return stop_signal == 0;
    };
    const machine::CheckResult result =
        machine::check_program(loaded.machine, words.program, tools, values, sink, check);
    progress.clear();
    if (result.isCancelled) {
        sink.error("stopped by " + stop_signal_name());
    }
    if (!words.plot.empty() && result.hasMoves) {
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

int command_check(const std::vector<std::string> &words) {
    if (wantsHelp(words)) {
        fmt::print("{}", USAGE);
        return 0;
    }
    const auto options = parse_options(words, {{}, {"--ini", "--statements", "--plot"}});
    if (!options.has_value()) {
        fmt::print(stderr, "millwright check: {}\n", options.error().str());
        return 2;
    }
    if (options->rest.size() != 1 || options->value("--ini").empty()) {
        fmt::print(stderr, "millwright check: needs a program and a machine: millwright check PROGRAM.ngc "
                           "--ini MACHINE.ini\n");
        return 2;
    }
    const std::string bound = options->value("--statements");
    const auto statements = bound.empty() ? std::optional<std::int64_t>() : parse_int(bound);
    if (!bound.empty() && (!statements || *statements < 0)) {
        fmt::print(stderr, "millwright check: --statements needs a whole number from 0 up, not '{}'\n",
                   bound);
        return 2;
    }
    const std::string plot = options->value("--plot");
    catch_stop_signals();
    diag::Sink sink([](const diag::Diagnostic &d) { fmt::print(stderr, "{}\n", d.str()); });
    const auto drawable = plot.empty() ? Result<>{} : check_picture(plot);
    if (!drawable.has_value()) {
        sink.error(drawable.error());
        return 1;
    }
    const auto loaded = machine::LoadedConfig::load(options->value("--ini"), sink);
    if (loaded == nullptr) {
        return 1;
    }
    auto tools = machine::ToolFile::load(loaded->machine.tool_table_file, &sink);
    if (!tools.has_value()) {
        sink.error(tools.error());
        return 1;
    }
    return check_loaded({options->rest[0], plot, statements}, *loaded, **tools, sink);
}

}  // namespace mw::app

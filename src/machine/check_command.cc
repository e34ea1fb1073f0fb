// SPDX-License-Identifier: GPL-2.0-or-later
// millwright check: interprets a program for a machine and checks its moves, moving nothing.
#include <cstdio>

#include <fmt/format.h>

#include "machine/commands.hh"
#include "machine/ini_parameters.hh"
#include "machine/loaded_config.hh"
#include "machine/options.hh"
#include "machine/program_check.hh"
#include "machine/time_report.hh"
#include "machine/tool_file.hh"

namespace mw::machine {
namespace {

void print_result(const std::string &program, const MachineConfig &machine, const CheckResult &result) {
    const char *unit = machine.isMetric ? "mm" : "in";
    fmt::print("{}: {} blocks, {} moves, cutting {:.3f} {}, rapid {:.3f} {}\n", program, result.blocks,
               result.moves, result.cutting_length, unit, result.rapid_length, unit);
    for (int axis = 0; axis < MAX_AXES && result.hasMoves; ++axis) {
        const auto i = static_cast<std::size_t>(axis);
        if ((machine.axis_mask & (1U << axis)) != 0) {
            fmt::print("  {} from {:.4f} to {:.4f} {}\n", geom::AXIS_LETTERS[axis], result.lowest[i],
                       result.highest[i], geom::isAngular(axis) ? "deg" : unit);
        }
    }
}

}  // namespace

int command_check(const std::vector<std::string> &words) {
    const auto options = parse_options(words, {{}, {"--ini"}});
    if (!options.has_value()) {
        fmt::print(stderr, "millwright check: {}\n", options.error().str());
        return 2;
    }
    if (options->rest.size() != 1 || options->value("--ini").empty()) {
        fmt::print(stderr, "millwright check: needs a program and a machine: millwright check PROGRAM.ngc "
                           "--ini MACHINE.ini\n");
        return 2;
    }
    diag::Sink sink([](const diag::Diagnostic &d) { fmt::print(stderr, "{}\n", d.str()); });
    const auto loaded = LoadedConfig::load(options->value("--ini"), sink);
    if (loaded == nullptr) {
        return 1;
    }
    auto tools = ToolFile::load(loaded->machine.tool_table_file);
    if (!tools.has_value()) {
        sink.error(tools.error());
        return 1;
    }
    const std::string &program = options->rest[0];
    IniParameters values(loaded->ini, nullptr);
    const CheckResult result = check_program(loaded->machine, program, **tools, values, sink);
    if (sink.hasErrors()) {
        fmt::print(stderr, "{}: {} error(s)\n", program, sink.count_errors());
        return 1;
    }
    print_result(program, loaded->machine, result);
    print_times(result.time);
    return 0;
}

}  // namespace mw::machine

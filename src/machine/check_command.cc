// SPDX-License-Identifier: GPL-2.0-or-later
// millwright check: interprets a program for a machine and checks its moves, moving nothing.
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <functional>
#include <optional>

#include <fmt/format.h>

#include "base/text.hh"
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

/// How far a long check is, on a terminal: a line that is written over twice a second.
class ProgressLine {
  public:
    bool operator()(const interp::PreviewProgress &now) {
        constexpr std::chrono::milliseconds EVERY{500};
        const auto time = std::chrono::steady_clock::now();
        if (isTerminal_ && time - last_ >= EVERY && now.bytes_in_all > 0) {
            last_ = time;
            isShown_ = true;
            fmt::print(stderr, "\r{:3.0f} % of the file, {} blocks ",
                       100.0 * static_cast<double>(now.bytes) / static_cast<double>(now.bytes_in_all),
                       now.blocks);
        }
        return true;
    }
    void clear() const {
        if (isShown_) {
            fmt::print(stderr, "\r{:60}\r", "");
        }
    }

  private:
    bool isTerminal_ = ::isatty(STDERR_FILENO) == 1;
    bool isShown_ = false;
    std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

}  // namespace

int command_check(const std::vector<std::string> &words) {
    const auto options = parse_options(words, {{}, {"--ini", "--statements"}});
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
    diag::Sink sink([](const diag::Diagnostic &d) { fmt::print(stderr, "{}\n", d.str()); });
    const auto loaded = LoadedConfig::load(options->value("--ini"), sink);
    if (loaded == nullptr) {
        return 1;
    }
    auto tools = ToolFile::load(loaded->machine.tool_table_file, &sink);
    if (!tools.has_value()) {
        sink.error(tools.error());
        return 1;
    }
    const std::string &program = options->rest[0];
    IniParameters values(loaded->ini, nullptr);
    ProgressLine progress;
    const CheckResult result =
        check_program(loaded->machine, program, **tools, values, sink, {std::ref(progress), statements});
    progress.clear();
    if (sink.hasErrors()) {
        fmt::print(stderr, "{}: {} error(s)\n", program, sink.count_errors());
        return 1;
    }
    print_result(program, loaded->machine, result);
    print_times(result.time);
    return 0;
}

}  // namespace mw::machine

// SPDX-License-Identifier: GPL-2.0-or-later
// millwright run: from the words of the command line to a finished program and its summary.
#include <unistd.h>

#include <cstdio>
#include <optional>

#include <fmt/format.h>

#include "base/text.hh"
#include "machine/commands.hh"
#include "machine/ini_parameters.hh"
#include "machine/loaded_config.hh"
#include "machine/machine.hh"
#include "machine/operator.hh"
#include "machine/options.hh"
#include "machine/plot.hh"
#include "machine/program_check.hh"
#include "machine/summary.hh"
#include "machine/time_report.hh"
#include "machine/tool_file.hh"
#include "machine/trace_writer.hh"

namespace mw::machine {
namespace {

constexpr double DEFAULT_PATIENCE_S = 60.0;

struct RunWords {
    std::string ini, program, trace, plot;
    bool isRealtime = false, isStrict = false, isEstimated = true;
    double patience_s = DEFAULT_PATIENCE_S;
};

Result<RunWords> parse_run(const std::vector<std::string> &words) {
    const auto options = parse_options(
        words, {{"--realtime", "--strict", "--no-estimate"}, {"--trace", "--plot", "--patience"}});
    if (!options.has_value()) {
        return std::unexpected(options.error());
    }
    if (options->rest.size() != 2) {
        return fail("run needs a machine's INI file and a program", {},
                    "millwright run MACHINE.ini PROGRAM.ngc");
    }
    RunWords run{options->rest[0], options->rest[1], options->value("--trace"), options->value("--plot")};
    run.isRealtime = options->has("--realtime");
    run.isStrict = options->has("--strict");
    run.isEstimated = !options->has("--no-estimate");
    const auto patience = parse_double(options->value("--patience", to_text(DEFAULT_PATIENCE_S)));
    if (!patience.has_value() || *patience <= 0) {
        return fail("--patience needs a number of seconds above 0");
    }
    run.patience_s = *patience;
    return run;
}

/// Keeps trace, figures and picture while the program runs.
class Recorder {
  public:
    Recorder(Machine &machine, const MachineConfig &config)
        : machine_(machine), monitor_(config.servo_period_ns) {
        machine_.task().set_move_listener(
            [this](motion::CommandId id, const motion::PathBody &body) { monitor_.on_move(id, body); });
    }

    Result<> open_trace(const std::string &path, const MachineConfig &config) {
        auto writer = TraceWriter::create(path, config.axis_mask, config.num_joints);
        if (!writer.has_value()) {
            return std::unexpected(writer.error());
        }
        trace_.emplace(std::move(*writer));
        return {};
    }
    void start() {
        monitor_.start(machine_.task().motion_status().carte_pos_cmd);
        machine_.channels().isTracing.store(1);
    }
    void drain() {
        motion::TraceSample sample;
        while (machine_.channels().trace.pop(sample)) {
            monitor_.on_sample(sample);
            if (trace_.has_value()) {
                trace_->write(sample);
            }
        }
    }
    Result<> finish() {
        drain();
        machine_.channels().isTracing.store(0);
        machine_.task().set_move_listener({});
        const std::uint64_t lost = machine_.channels().trace_lost.load();
        const auto closed = trace_.has_value() ? trace_->close() : Result<>{};
        if (closed.has_value() && trace_.has_value() && lost > 0) {
            return fail(fmt::format(
                "the trace lacks {} servo cycles: this process was too slow to write them", lost));
        }
        return closed;
    }
    const PathMonitor &monitor() const { return monitor_; }

  private:
    Machine &machine_;
    PathMonitor monitor_;
    std::optional<TraceWriter> trace_;
};

Result<> run_program(const RunWords &words, LoadedConfig &loaded, Operator &person, Recorder &recorder) {
    auto status = person.switch_on();
    status = status.has_value() ? person.home_all() : status;
    status = status.has_value() ? person.open_program(words.program) : status;
    if (status.has_value() && !words.trace.empty()) {
        status = recorder.open_trace(words.trace, loaded.machine);
    }
    if (!status.has_value()) {
        return status;
    }
    recorder.start();
    status = person.run_program([&recorder] { recorder.drain(); });
    const auto finished = recorder.finish();
    return status.has_value() ? finished : status;
}

/// The time that the planner expects. Nothing when the program has errors: running it tells them.
std::optional<TimeFigures> estimate(const RunWords &words, LoadedConfig &loaded) {
    auto tools = ToolFile::load(loaded.machine.tool_table_file);
    if (!words.isEstimated || !tools.has_value()) {
        return std::nullopt;
    }
    diag::Sink silent;
    IniParameters values(loaded.ini, nullptr);
    const CheckResult result = check_program(loaded.machine, words.program, **tools, values, silent);
    return silent.hasErrors() ? std::nullopt : std::optional(result.time);
}

/// A failure with no message has been told already, where it happened.
void report(diag::Sink &sink, const Error &error) {
    if (!error.message.empty()) {
        sink.error(error);
    }
}

}  // namespace

int command_run(const std::vector<std::string> &arguments) {
    const auto words = parse_run(arguments);
    if (!words.has_value()) {
        fmt::print(stderr, "millwright run: {}\n", words.error().str());
        return 2;
    }
    diag::Sink sink([](const diag::Diagnostic &d) { fmt::print(stderr, "{}\n", d.str()); });
    auto loaded = LoadedConfig::load(words->ini, sink);
    if (loaded == nullptr) {
        return 1;
    }
    if (!loaded->machine.display.empty()) {
        sink.note("[DISPLAY]DISPLAY = " + loaded->machine.display + " is not started by millwright run");
    }
    const MachineParts parts{loaded->ini, loaded->reader, loaded->machine, sink};
    MachineOptions options;
    options.isStrict = words->isStrict;
    auto machine =
        words->isRealtime ? make_realtime_machine(parts, options) : make_virtual_machine(parts, options);
    if (!machine.has_value()) {
        report(sink, machine.error());
        return 1;
    }
    const std::optional<TimeFigures> expected = estimate(*words, *loaded);
    Operator person(**machine, loaded->machine, sink, words->patience_s);
    Recorder recorder(**machine, loaded->machine);
    auto status = run_program(*words, *loaded, person, recorder);
    person.switch_off();
    if (status.has_value()) {
        status = (*machine)->task().save_parameters();
    }
    if (!status.has_value()) {
        report(sink, status.error());
        return 1;
    }
    print_summary({words->program, loaded->machine, person.figures(), recorder.monitor().figures(),
                   (*machine)->realtime_figures(), words->isRealtime});
    if (expected.has_value()) {
        fmt::print("expected by the planner\n");
        print_times(*expected);
    }
    if (!words->plot.empty()) {
        const auto drawn =
            plot_path(recorder.monitor().points(), words->program + " on " + loaded->machine.name,
                      loaded->machine.isMetric ? "mm" : "inch", words->plot);
        if (!drawn.has_value()) {
            sink.error(drawn.error());
            return 1;
        }
        fmt::print("picture             {}\n", words->plot);
    }
    return 0;
}

}  // namespace mw::machine

// SPDX-License-Identifier: GPL-2.0-or-later
// millwright run: from the words of the command line to a finished program and its summary.
#include <cstdio>
#include <optional>

#include <fmt/format.h>

#include "app/commands.hh"
#include "app/operator.hh"
#include "app/options.hh"
#include "app/plot.hh"
#include "app/start_check.hh"
#include "app/summary.hh"
#include "app/time_report.hh"
#include "app/trace_writer.hh"
#include "base/stop_signals.hh"
#include "base/text.hh"
#include "machine/ini_parameters.hh"
#include "machine/loaded_config.hh"
#include "machine/machine.hh"
#include "machine/tool_file.hh"

namespace mw::app {
namespace {

constexpr double DEFAULT_PATIENCE_S = 60.0;

constexpr const char *USAGE =
    "usage: millwright run MACHINE.ini PROGRAM.ngc [options]\n"
    "\n"
    "Starts the machine that the INI file describes, homes it and runs the program. Before anything moves "
    "the\n"
    "program is interpreted, for at most 5 s: one that is known to stop in the middle of a cut is refused.\n"
    "Displays that the INI file names are not started.\n"
    "\n"
    "In virtual time (the default) a simulated operator confirms tool changes and passes program stops, and "
    "says\n"
    "so. With --realtime a person does, by keys or by HAL pins (halui, hal_manualtoolchange):\n"
    "  y start    h or space hold    r resume    a abort    t the tool is changed\n"
    "\n"
    "  --realtime            by the clock, in two processes; asks at the terminal before it switches on\n"
    "  --yes                 do not ask before the start, and start without a terminal; confirms nothing "
    "else\n"
    "  --trace FILE.csv      write the commanded positions of every servo cycle\n"
    "  --plot FILE           draw the tool path, as .png or .svg; of a refused program too\n"
    "  --patience SECONDS    give up after so long without progress (default 60, in the machine's time)\n"
    "  --optional-stop on|off, --block-delete on|off\n"
    "                        M1 stops; lines that begin with / are left out (both on)\n"
    "  --no-estimate         do not reckon the time that the planner expects\n"
    "  --no-check            start even a program that is known to fail\n"
    "  --strict              unknown INI keys are errors\n"
    "\n"
    "exit status: 0 the program ran to its end, 1 refused, failed or stopped, 2 wrong usage\n";

struct RunWords {
    std::string ini, program, trace, plot;
    bool isRealtime = false, isStrict = false, isEstimated = true, isChecked = true, isConfirmed = false;
    ProgramSwitches switches;
    double patience_s = DEFAULT_PATIENCE_S;
};

Result<RunWords> parse_run(const std::vector<std::string> &words) {
    const auto options =
        parse_options(words, {{"--realtime", "--strict", "--no-estimate", "--no-check", "--yes"},
                              {"--trace", "--plot", "--patience", "--optional-stop", "--block-delete"}});
    if (!options.has_value()) {
        return std::unexpected(options.error());
    }
    if (options->rest.size() != 2) {
        return fail("run needs a machine's INI file and a program", {},
                    "millwright run MACHINE.ini PROGRAM.ngc");
    }
    RunWords run;
    run.ini = options->rest[0];
    run.program = options->rest[1];
    run.trace = options->value("--trace");
    run.plot = options->value("--plot");
    run.isRealtime = options->has("--realtime");
    run.isStrict = options->has("--strict");
    run.isEstimated = !options->has("--no-estimate");
    run.isChecked = !options->has("--no-check");
    run.isConfirmed = options->has("--yes");
    const auto patience = parse_double(options->value("--patience", to_text(DEFAULT_PATIENCE_S)));
    if (!patience.has_value() || *patience <= 0) {
        return fail("--patience needs a number of seconds above 0");
    }
    run.patience_s = *patience;
    const auto optional_stop = options->on_or_off("--optional-stop", true);
    const auto block_delete = options->on_or_off("--block-delete", true);
    if (!optional_stop.has_value() || !block_delete.has_value()) {
        return std::unexpected(optional_stop.has_value() ? block_delete.error() : optional_stop.error());
    }
    run.switches.isOptionalStopOn = *optional_stop;
    run.switches.isBlockDeleteOn = *block_delete;
    return run;
}

/// Keeps trace, figures and picture while the program runs.
class Recorder {
  public:
    Recorder(machine::Machine &machine, const machine::MachineConfig &config)
        : machine_(machine), monitor_(config.servo_period_ns) {
        machine_.task().set_move_listener(
            [this](motion::CommandId id, const motion::PathBody &body) { monitor_.on_move(id, body); });
    }

    Result<> open_trace(const std::string &path, const machine::MachineConfig &config) {
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
    const machine::PathMonitor &monitor() const { return monitor_; }

  private:
    machine::Machine &machine_;
    machine::PathMonitor monitor_;
    std::optional<TraceWriter> trace_;
};

/// One `millwright run`, from a configuration that is loaded.
class Run {
  public:
    Run(const RunWords &words, machine::LoadedConfig &loaded, diag::Sink &sink)
        : words_(words), loaded_(loaded), sink_(sink) {}

    int run() {
        if (!isAllowed() || !check()) {
            return 1;
        }
        auto machine = make();
        if (!machine.has_value()) {
            report(machine.error());
            return 1;
        }
        OperatorOptions options;
        options.patience_s = words_.patience_s;
        options.attendance = !words_.isRealtime    ? Attendance::SIMULATED
                             : Keyboard::isThere() ? Attendance::TERMINAL
                                                   : Attendance::NOBODY;
        Operator person(**machine, loaded_.machine, sink_, options);
        Recorder recorder(**machine, loaded_.machine);
        auto status = go(person, recorder);
        person.switch_off();
        if (status.has_value()) {
            status = (*machine)->task().save_parameters();
        }
        if (!status.has_value()) {
            report(status.error());
            return 1;
        }
        print_summary({words_.program, loaded_.machine, person.figures(), recorder.monitor().figures(),
                       (*machine)->realtime_figures(), words_.isRealtime, check_});
        if (check_.time.has_value()) {
            fmt::print("expected by the planner\n");
            print_times(*check_.time);
        }
        return draw(recorder.monitor().points()) ? 0 : 1;
    }

  private:
    /// What can be refused before anything is made.
    bool isAllowed() {
        if (words_.isRealtime && !words_.isConfirmed && !Keyboard::isThere()) {
            report(
                {"--realtime asks a person at the terminal before it switches the machine on, and there is "
                 "none",
                 {},
                 "--yes starts unasked; stops and tool changes then wait for HAL pins (halui.program.resume, "
                 "hal_manualtoolchange.change_button)"});
            return false;
        }
        const auto drawable = words_.plot.empty() ? Result<>{} : check_picture(words_.plot);
        if (!drawable.has_value()) {
            report(drawable.error());
        }
        return drawable.has_value();
    }

    bool check() {
        auto tools = machine::ToolFile::load(loaded_.machine.tool_table_file, &sink_);
        if (!tools.has_value()) {
            report(tools.error());
            return false;
        }
        machine::IniParameters values(loaded_.ini, nullptr);
        machine::PathPoints points;
        diag::Sink unheard;
        StartCheckOptions options;
        options.wantsTime = words_.isEstimated;
        options.isBlockDeleteOn = words_.switches.isBlockDeleteOn;
        options.points = &points;
        check_ = check_before_start(loaded_.machine, words_.program, **tools, values,
                                    words_.isChecked ? sink_ : unheard, options);
        if (stop_signal != 0) {
            report({"stopped by " + stop_signal_name() + " before the start"});
            return false;
        }
        if (!check_.isRefused) {
            return true;
        }
        if (!words_.isChecked) {
            sink_.warning("the program will stop before its end: it is started because of --no-check");
            return true;
        }
        fmt::print(stderr, "{} is not started, since it would stop there; nothing has moved\n",
                   words_.program);
        draw(points.all());
        return false;
    }

    Result<std::unique_ptr<machine::Machine>> make() {
        const machine::MachineParts parts{loaded_.ini, loaded_.reader, loaded_.machine, sink_};
        machine::MachineOptions options;
        options.isStrict = words_.isStrict;
        options.isToolTableTold = true;
        return words_.isRealtime ? machine::make_realtime_machine(parts, options)
                                 : machine::make_virtual_machine(parts, options);
    }

    Result<> go(Operator &person, Recorder &recorder) {
        if (stop_signal != 0) {
            return fail("stopped by " + stop_signal_name() + " before the start");
        }
        if (words_.isRealtime && !words_.isConfirmed &&
            !person.confirm(
                fmt::format("switch {} on, home it and run {}?", loaded_.machine.name, words_.program))) {
            return fail("not started");
        }
        auto status = person.switch_on();
        status = status.has_value() ? person.home_all() : status;
        status = status.has_value() ? person.set_switches(words_.switches) : status;
        status = status.has_value() ? person.open_program(words_.program) : status;
        if (status.has_value() && !words_.trace.empty()) {
            status = recorder.open_trace(words_.trace, loaded_.machine);
        }
        if (!status.has_value()) {
            return status;
        }
        recorder.start();
        status = person.run_program([&recorder] { recorder.drain(); });
        const auto finished = recorder.finish();
        return status.has_value() ? finished : status;
    }

    bool draw(const std::vector<machine::PathPoint> &points) {
        if (words_.plot.empty()) {
            return true;
        }
        const auto drawn = plot_path(points, loaded_.machine, words_.program, words_.plot);
        if (!drawn.has_value()) {
            report(drawn.error());
            return false;
        }
        fmt::print("picture             {}\n", words_.plot);
        return true;
    }

    /// A failure with no message has been told already, where it happened.
    void report(const Error &error) {
        if (!error.message.empty()) {
            sink_.error(error);
        }
    }

    const RunWords &words_;
    machine::LoadedConfig &loaded_;
    diag::Sink &sink_;
    StartCheck check_;
};

}  // namespace

int command_run(const std::vector<std::string> &arguments) {
    if (wantsHelp(arguments)) {
        fmt::print("{}", USAGE);
        return 0;
    }
    const auto words = parse_run(arguments);
    if (!words.has_value()) {
        fmt::print(stderr, "millwright run: {}\n", words.error().str());
        return 2;
    }
    catch_stop_signals();
    diag::Sink sink([](const diag::Diagnostic &d) { fmt::print(stderr, "{}\n", d.str()); });
    auto loaded = machine::LoadedConfig::load(words->ini, sink);
    return loaded == nullptr ? 1 : Run(*words, *loaded, sink).run();
}

}  // namespace mw::app

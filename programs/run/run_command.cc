// SPDX-License-Identifier: GPL-2.0-or-later
// millwright run: from the words of the command line to a finished program and its summary.
#include <algorithm>
#include <cstdio>

#include <fmt/format.h>

#include "base/language/language.hh"
#include "base/options/command_line.hh"
#include "base/output_relay.hh"
#include "base/stop_signals.hh"
#include "base/whole_path.hh"
#include "hal/core/instance.hh"
#include "machine/assembly/machine.hh"
#include "machine/config/ini_parameters.hh"
#include "machine/config/loaded_config.hh"
#include "machine/task/task.hh"
#include "machine/tools/tool_data.hh"
#include "programs/commands.hh"
#include "programs/run/certificate_report.hh"
#include "programs/run/machine_access.hh"
#include "programs/run/plot.hh"
#include "programs/run/recorder.hh"
#include "programs/run/run_session.hh"
#include "programs/run/run_words.hh"
#include "programs/run/start_check.hh"
#include "programs/run/summary.hh"
#include "programs/run/time_report.hh"

namespace mw::programs {
namespace {

/// One `millwright run` with a loaded configuration.
class Run {
  public:
    Run(RunWords words, machine::LoadedConfig &loaded, diagnostics::Sink &sink)
        : words_(std::move(words)), loaded_(loaded), sink_(sink) {}

    int run() {
        if (!isAllowed()) {
            return 1;
        }
        Result<std::unique_ptr<RunningMachine>> running = nullptr;
        if (words_.realtime) {  // a simulation never uses a running machine
            running = RunningMachine::find(hal::default_instance(), words_.ini);
        }
        if (!running.has_value()) {
            sink_.failure(running.error());
            return 1;
        }
        return *running != nullptr ? run_there(**running) : run_here();
    }

  private:
    /// Runs on a machine created only for this program.
    int run_here() {
        if (!check(0)) {
            return 1;
        }
        auto machine = make();
        if (!machine.has_value()) {
            sink_.failure(machine.error());
            return 1;
        }
        OwnMachine own(**machine);
        RunSession person(own, loaded_.machine, sink_, operator_options());
        Recorder recorder(**machine, loaded_.machine);
        auto status = isStarted(person);
        status = status.has_value() ? go(person, &recorder) : status;
        person.switch_off();
        if (status.has_value()) {
            status = (*machine)->task().save_parameters();
        }
        const CertificateReport certificate = certificate_of(**machine, person, recorder, status.has_value());
        const bool isWritten = !recorder.hasStarted() || write(certificate);
        if (!status.has_value()) {
            sink_.failure(status.error());
            return 1;
        }
        tell_end({words_.program, loaded_.machine, person.figures(), recorder.monitor().figures(),
                  certificate_table(certificate), (*machine)->realtime_figures(), words_.realtime, check_});
        return draw(recorder.monitor().points()) && isWritten ? 0 : 1;
    }

    CertificateReport certificate_of(machine::Machine &machine, const RunSession &person,
                                     const Recorder &recorder, bool wasFinished) const {
        return {.program = words_.program,
                .machine = loaded_.machine,
                .certificate = recorder.certificate(),
                .cycle_time_s = person.figures().cycle_time_s,
                .wasFinished = wasFinished,
                .was_realtime = words_.realtime,
                .file_name = [&machine](std::uint32_t index) { return machine.task().file_name(index); }};
    }

    bool write(const CertificateReport &certificate) {
        const auto written =
            words_.certificate.empty() ? Result<>{} : write_certificate(certificate, words_.certificate);
        if (!written.has_value()) {
            sink_.failure(written.error());
        }
        return written.has_value();
    }

    /// Runs on a running machine, which continues afterwards.
    int run_there(RunningMachine &machine) {
        RunSession person(machine, loaded_.machine, sink_, operator_options());
        if (!isForClients() || !check(person.status().tool.in_spindle)) {
            return 1;
        }
        words_.program = whole_path(words_.program);  // absolute, because another process opens it
        auto status = isStarted(person);
        status = status.has_value() ? machine.take_over() : status;
        if (status.has_value()) {
            status = go(person, nullptr);
            if (!status.has_value()) {
                person.stop();
            }
            machine.give_back();
        }
        if (!status.has_value()) {
            sink_.failure(status.error());
            return 1;
        }
        tell_end({words_.program, loaded_.machine, person.figures(), {}, {}, {}, words_.realtime, check_});
        return 0;
    }

    RunSessionOptions operator_options() const {
        RunSessionOptions options;
        options.patience_s = words_.patience_s;
        options.attendance = !words_.realtime      ? Attendance::SIMULATED
                             : Keyboard::isThere() ? Attendance::TERMINAL
                                                   : Attendance::NOBODY;
        return options;
    }

    void tell_end(const Summary &summary) const {
        print_summary(summary);
        if (check_.time.has_value()) {
            fmt::print("expected by the planner\n");
            print_times(*check_.time);
        }
    }

    /// Checks that need no machine.
    bool isAllowed() {
        if (words_.realtime && !words_.confirmed && !Keyboard::isThere()) {
            sink_.failure({"--realtime needs a terminal to confirm that the machine may be switched on",
                           {},
                           "--yes starts without confirmation; stops and tool changes then wait for HAL pins "
                           "(halui.program.resume, hal_manualtoolchange.change_button)"});
            return false;
        }
        const auto drawable = words_.plot.empty() ? Result<>{} : check_picture(words_.plot);
        if (!drawable.has_value()) {
            sink_.failure(drawable.error());
        }
        return drawable.has_value();
    }

    /// Rejects options that need the machine's process.
    bool isForClients() {
        const char *option = !words_.trace.empty()            ? "--trace"
                             : !words_.certificate.empty()    ? "--certificate"
                             : !words_.plot.empty()           ? "--plot"
                             : words_.strict                  ? "--strict"
                             : !words_.homing_module.empty()  ? "--homemod"
                             : !words_.planner_module.empty() ? "--tpmod"
                                                              : nullptr;
        if (option != nullptr) {
            sink_.error(
                {fmt::format("{} needs a separate machine for this program, but a machine is already running",
                             option),
                 {},
                 "omit the option, or end 'millwright start'; millwright check draws programs"});
        }
        return option == nullptr;
    }

    /// `tool` is the tool in the spindle, 0: none.
    bool check(int tool) {
        auto tools = machine::read_tools(loaded_.machine, sink_);
        if (!tools.has_value()) {
            sink_.failure(tools.error());
            return false;
        }
        if (tool > 0 && !(*tools)->isRandom()) {
            static_cast<void>((*tools)->load_spindle(std::max(0, (*tools)->index_of_tool(tool))));
        }
        machine::IniParameters values(loaded_.ini, nullptr);
        gcode::PathPoints points;
        diagnostics::Sink unheard;
        StartCheckOptions options;
        options.wants_time = words_.estimated;
        options.block_delete_on = words_.switches.block_delete_on;
        options.points = &points;
        check_ = check_before_start(loaded_.machine, words_.program, **tools, values,
                                    words_.checked ? sink_ : unheard, options);
        if (stop_signal != 0) {
            sink_.failure({"stopped by " + stop_signal_name() + " before the start"});
            return false;
        }
        if (!check_.isRefused) {
            return true;
        }
        if (!words_.checked) {
            sink_.warning("the program will stop before its end: it is started because of --no-check");
            return true;
        }
        fmt::print(stderr, "{} is not started because it would stop there; nothing has moved\n",
                   words_.program);
        draw(points.all());
        return false;
    }

    Result<std::unique_ptr<machine::Machine>> make() {
        const machine::MachineParts parts{loaded_.ini, loaded_.reader, loaded_.machine, sink_};
        machine::MachineOptions options;
        options.strict = words_.strict;
        options.homing_module = words_.homing_module;
        options.planner_module = words_.planner_module;
        options.tool_table_reported = true;
        return words_.realtime ? machine::make_realtime_machine(parts, options)
                               : machine::make_virtual_machine(parts, options);
    }

    /// Starts, after confirmation by a person if required.
    Result<> isStarted(RunSession &person) {
        if (stop_signal != 0) {
            return fail("stopped by " + stop_signal_name() + " before the start");
        }
        const messages::MachineStatus &now = person.status();
        const bool ready = now.task.state == messages::State::ON && now.trajectory.isAllHomed;
        const std::string question =
            ready ? fmt::format("run {} on {}?", words_.program, loaded_.machine.name)
                  : fmt::format("switch {} on, home it and run {}?", loaded_.machine.name, words_.program);
        const bool requested = words_.realtime && !words_.confirmed;
        return requested && !person.confirm(question) ? fail("not started") : Result<>{};
    }

    Result<> go(RunSession &person, Recorder *recorder) {
        auto status = person.switch_on();
        status = status.has_value() ? person.home_all() : status;
        status = status.has_value() ? person.set_switches(words_.switches) : status;
        status = status.has_value() ? person.open_program(words_.program) : status;
        if (status.has_value() && recorder != nullptr && !words_.trace.empty()) {
            status = recorder->open_trace(words_.trace, loaded_.machine);
        }
        if (!status.has_value() || recorder == nullptr) {
            return status.has_value() ? person.run_program(words_.from_line, [] {}) : status;
        }
        recorder->start();
        status = person.run_program(words_.from_line, [recorder] { recorder->drain(); });
        const auto finished = recorder->finish(status.has_value() ? machine::ProgramEnd::COMPLETE
                                                                  : machine::ProgramEnd::STOPPED);
        return status.has_value() ? finished : status;
    }

    bool draw(const std::vector<gcode::PathPoint> &points) {
        if (words_.plot.empty()) {
            return true;
        }
        const auto drawn = plot_path(points, loaded_.machine, words_.program, words_.plot);
        if (!drawn.has_value()) {
            sink_.failure(drawn.error());
            return false;
        }
        fmt::print("picture             {}\n", words_.plot);
        return true;
    }

    RunWords words_;
    machine::LoadedConfig &loaded_;
    diagnostics::Sink &sink_;
    StartCheck check_;
};

}  // namespace

int command_run(const std::vector<std::string> &arguments) {
    if (options::wantsHelp(arguments)) {
        fmt::print("{}", run_help());
        return 0;
    }
    const auto words = parse_run(arguments);
    if (!words.has_value()) {
        fmt::print(stderr, "millwright run: {}\n", language::shown(words.error().str()));
        return 2;
    }
    catch_stop_signals();
    diagnostics::Sink sink(
        [](const diagnostics::Diagnostic &d) { fmt::print(stderr, "{}\n", language::shown(d.str())); });
    auto loaded = machine::LoadedConfig::load(words->ini, sink);
    if (loaded == nullptr) {
        return 1;
    }
    // Virtual time may wait for the reader of the output, a machine must not.
    const std::string why = words->realtime ? OutputRelay::begin() : "";
    if (!why.empty()) {
        sink.warning("a stopped terminal can delay the machine: " + why);
    }
    const int status = Run(*words, *loaded, sink).run();
    OutputRelay::end();
    return status;
}

}  // namespace mw::programs

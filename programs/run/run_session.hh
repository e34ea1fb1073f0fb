// SPDX-License-Identifier: GPL-2.0-or-later
// Does the work of an operator: switches the machine on, homes it, opens and runs a program and watches it.
// If the machine was on and homed before, it remains so.
#pragma once

#include <functional>
#include <string>

#include "base/diagnostics/sink.hh"
#include "programs/run/machine_access.hh"
#include "programs/run/terminal_panel.hh"

namespace mw::programs {

struct RunSessionFigures {
    double cycle_time_s = 0;  ///< time of the program, in machine time
    double wall_time_s = 0;
    std::uint64_t blocks = 0;
    int stops_passed = 0;  ///< M0, M1 and M60
    int warnings = 0;
};

struct ProgramSwitches {
    bool optional_stop_on = true;  ///< M1 stops the program
    bool block_delete_on = true;   ///< lines that begin with / are skipped
};

struct RunSessionOptions {
    double patience_s = 60.0;  ///< machine time without progress after which waiting ends
    Attendance attendance = Attendance::SIMULATED;
};

/// Stop signals (base/stop_signals.hh) end every wait with a controlled stop.
class RunSession {
  public:
    RunSession(MachineAccess &machine, const machine::MachineConfig &config, diagnostics::Sink &sink,
               const RunSessionOptions &options);

    /// Asks the person at the terminal; false if the person declines, or there is none.
    bool confirm(const std::string &question) { return panel_.confirm(question); }

    Result<> switch_on();
    /// Homes all joints in sequence, then those without a sequence one by one.
    Result<> home_all();
    Result<> set_switches(const ProgramSwitches &switches);
    Result<> open_program(const std::string &path);
    /// Runs to the end, beginning at a line (0: the first). `each_cycle` is called after every task cycle.
    Result<> run_program(int from_line, const std::function<void()> &each_cycle);
    /// Stops all motion; the machine remains on.
    void stop();
    /// Stops all motion and switches the machine off.
    void switch_off();

    /// Status of the last cycle.
    const messages::MachineStatus &status() const { return machine_.client().status(); }

    RunSessionFigures figures() const;

  private:
    Result<> ask(const messages::Command &command, const std::string &what);
    /// Runs cycles until the request ends. The error names the missing condition.
    Result<> wait_for(const Result<client::Serial> &posted, const std::string &what,
                      const std::function<void()> &each_cycle);
    /// Runs one task cycle, and reads the status after it.
    void cycle();
    void show_messages();
    bool hasProgress();
    Result<> stop_on_signal();

    MachineAccess &machine_;
    const machine::MachineConfig &config_;
    diagnostics::Sink &sink_;
    TerminalPanel panel_;
    std::int64_t patience_ns_;
    RunSessionFigures figures_;
    std::string last_error_;
    int program_lines_ = 0;
    struct Mark {
        std::uint64_t blocks = 0;
        geometry::Pose position;
        std::array<double, MAX_JOINTS> joints{};
        bool operator==(const Mark &) const = default;
    } mark_;
};

}  // namespace mw::programs

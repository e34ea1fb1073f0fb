// SPDX-License-Identifier: GPL-2.0-or-later
// Does what a person at the machine does: switches on, homes, opens and runs a program, watches it.
#pragma once

#include <chrono>
#include <functional>
#include <string>

#include "diag/sink.hh"
#include "machine/machine.hh"

namespace mw::machine {

struct OperatorFigures {
    double cycle_time_s = 0;  ///< of the program, in the machine's time
    double wall_time_s = 0;
    std::uint64_t blocks = 0;
    int stops_passed = 0;  ///< M0, M1 and M60
    int warnings = 0;
};

class Operator {
  public:
    /// `patience_s`: machine time without progress after which waiting ends.
    Operator(Machine &machine, const MachineConfig &config, diag::Sink &sink, double patience_s);
    ~Operator();

    Result<> switch_on();
    /// Home all by sequence, then whatever has none, one by one.
    Result<> home_all();
    Result<> open_program(const std::string &path);
    /// Runs to the end. `each_cycle` is called after every task cycle.
    Result<> run_program(const std::function<void()> &each_cycle);
    /// Stops whatever moves and switches the machine off.
    void switch_off();

    OperatorFigures figures() const;

  private:
    Result<> ask(task::Command command, const std::string &what);
    /// Goes on until the request ends. The error says what is waited for.
    Result<> wait_for(task::RequestId id, const std::string &what, const std::function<void()> &each_cycle);
    void show_messages();
    bool hasProgress();
    void show_progress(bool isLast);
    Result<> stop_on_signal();

    Machine &machine_;
    const MachineConfig &config_;
    diag::Sink &sink_;
    std::int64_t patience_ns_;
    OperatorFigures figures_;
    std::string last_error_;
    bool isShowingProgress_ = false;
    int program_lines_ = 0;
    std::chrono::steady_clock::time_point last_shown_{};
    struct Mark {
        std::uint64_t blocks = 0;
        geom::Pose position;
        std::array<double, MAX_JOINTS> joints{};
        bool operator==(const Mark &) const = default;
    } mark_;
};

}  // namespace mw::machine

// SPDX-License-Identifier: GPL-2.0-or-later
// Runs a plan: operators perform the acts, faults occur at their times. Keeps the possible states of the
// machine according to the facts, and compares.
#pragma once

#include <vector>

#include "task_campaign/beliefs.hh"
#include "task_campaign/operators.hh"

namespace mw::task_campaign {

/// Runs in a separate folder, which contains the files of the machine.
class Session : private Operators {
  public:
    Session(const Plan &plan, const std::filesystem::path &folder, std::FILE *tell);
    Verdict run();

  private:
    /// The final state of a run.
    enum class End { DONE, FAILED, REFUSED, CRASHED };
    /// A line of MDI that was entered.
    struct Typed {
        Serial serial = 0;
        std::int64_t done_ms = -1;  ///< false before
    };

    bool prepare(messages::Mode mode);
    void check();

    // --- session_acts.cc
    void perform(const Act &act);
    void turn_switches(const Act &act);
    void work_by_hand(const Act &act);
    void jog(const Act &act);
    void home(const Act &act);
    void set_table(const Act &act);
    void change_state(const Act &act);
    void try_odd(int client, std::uint64_t seed, bool isAtRest);
    void operate_alone(const Act &act);

    // --- session_troubles.cc
    void begin_troubles(const Act &act);
    void step_troubles();
    void begin(const Trouble &trouble);
    void leave(const Trouble &trouble);
    void crash(bool isPowerCut);
    void note_stop();

    // --- session_program.cc
    void run_program(const Act &act);
    End end_of(Serial run, std::uint64_t ended_before) const;
    void end_program_of(const Act &act, End end);
    void end_by_crash(const Act &act);
    void recover(const Act &act, const World &before, bool isBlockDelete);

    // --- session_mdi.cc
    void run_mdi(const Act &act);
    void step_mdi(std::vector<Typed> &typed);
    std::vector<World> after_line(const Line &line, const Typed &typed, const std::vector<World> &before);

    const Plan &plan_;
    Beliefs beliefs_;
    // --- state of the current act
    const Act *act_ = nullptr;
    std::int64_t began_ms_ = 0;
    std::uint64_t ended_before_ = 0;  ///< programs
    std::size_t next_trouble_ = 0;
    bool isStopped_ = false;      ///< by a fault: any result is permitted
    bool areDevicesOff_ = false;  ///< by a stop of the operator
    bool isCrashed_ = false;
    bool wasRunning_ = false;              ///< at the crash
    std::uint64_t runs_before_crash_ = 0;  ///< runs of the program that had ended before the interrupted one
    bool wasBlockDelete_ = true, wasOptionalStop_ = true;
};

}  // namespace mw::task_campaign

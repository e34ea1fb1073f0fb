// SPDX-License-Identifier: GPL-2.0-or-later
// The display for a person at the machine while a program runs, and its keys.
#pragma once

#include <chrono>
#include <optional>
#include <string>

#include "programs/run/keyboard.hh"
#include "programs/run/machine_access.hh"

namespace mw::programs {

/// How requests of a program to a person are answered.
enum class Attendance : std::uint8_t {
    SIMULATED,  ///< program stops are passed at once, and reported
    TERMINAL,   ///< by a person with keys at this terminal, or by HAL pins
    NOBODY,     ///< only by HAL pins; without them a stop lasts until a signal arrives
};

/// One thread; step() does not block.
class TerminalPanel {
  public:
    TerminalPanel(MachineAccess &machine, const machine::MachineConfig &config, diagnostics::Sink &sink,
                  Attendance attendance);

    /// Asks a yes-or-no question at the terminal while the machine runs; false also on a signal.
    bool confirm(const std::string &question);

    /// From now on a status line shows the progress of the program.
    void begin_program(int lines);
    void end_program();

    /// Called once in each task cycle: handles keys and program stops, and updates the line.
    void step();
    /// Shows a message for the operator above the line.
    void show(const client::Client::Message &message);

    /// True while the program waits for a person, so that the timeout for progress is suspended.
    bool isWaitingForPerson() const;
    int stops_passed() const { return stops_passed_; }

  private:
    /// Status of the last cycle, as read by the machine's owner.
    const messages::MachineStatus &status() const { return machine_.client().status(); }
    void take_key(char key);
    void post(const messages::Command &command);
    void look_at_stop();
    void look_at_approach();
    void write_line();
    void clear_line();
    int line_reached();
    std::string progress_text();
    std::string position_text() const;

    MachineAccess &machine_;
    const machine::MachineConfig &config_;
    diagnostics::Sink &sink_;
    Attendance attendance_;
    std::optional<Keyboard> keyboard_;
    bool has_line_;  ///< standard error is a terminal
    bool running_ = false;
    std::uint64_t stops_told_ = 0;     ///< number of stops reported, as counted by Status::stops
    std::uint64_t approach_told_ = 0;  ///< number of the reported proposal
    int stops_passed_ = 0;
    int lines_ = 0, line_ = 0;
    std::chrono::steady_clock::time_point last_written_{}, last_key_{};
};

}  // namespace mw::programs

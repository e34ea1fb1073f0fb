// SPDX-License-Identifier: GPL-2.0-or-later
// What a person at the machine sees while a program runs, and the keys that answer.
#pragma once

#include <chrono>
#include <optional>
#include <string>

#include "programs/run/keyboard.hh"
#include "programs/run/machine_access.hh"

namespace mw::programs {

/// Who answers when the program asks for a person.
enum class Attendance : std::uint8_t {
    SIMULATED,  ///< program stops are passed at once, and said
    TERMINAL,   ///< a person at this terminal, by keys; HAL pins work as well
    NOBODY,     ///< only HAL pins: without them a stop holds until a signal comes
};

/// One thread; step() never blocks.
class TerminalPanel {
  public:
    TerminalPanel(MachineAccess &machine, const machine::MachineConfig &config, diagnostics::Sink &sink,
                  Attendance attendance);

    /// Asks for yes or no at the terminal while the machine goes on; false also when a signal comes.
    bool confirm(const std::string &question);

    /// From here on a line that is written over shows how far the program is.
    void begin_program(int lines);
    void end_program();

    /// Once a task cycle: keys, program stops, the line.
    void step();
    /// A message for the operator, above the line.
    void show(const client::Client::Message &message);

    /// Nothing goes on before a person has answered: neither does the time in which progress is expected.
    bool isWaitingForPerson() const;
    int stops_passed() const { return stops_passed_; }

  private:
    /// Of the last cycle, as whoever runs the machine has read it.
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
    bool hasLine_;  ///< standard error is a terminal
    bool isRunning_ = false;
    std::uint64_t stops_told_ = 0;     ///< as Status::stops counts them
    std::uint64_t approach_told_ = 0;  ///< number of the proposal
    int stops_passed_ = 0;
    int lines_ = 0, line_ = 0;
    std::chrono::steady_clock::time_point last_written_{}, last_key_{};
};

}  // namespace mw::programs

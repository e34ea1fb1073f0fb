// SPDX-License-Identifier: GPL-2.0-or-later
// Goes through a program to the place where it is to begin, without moving anything.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>

#include "gcode/interpreter/interpreter.hh"
#include "machine/task/run/canon_switch.hh"

namespace mw::task {

/// One thread; step() is bounded by its argument.
class BlockSearch {
  public:
    enum class Outcome : std::uint8_t {
        GOING,
        FOUND,    ///< the next step of the interpreter runs the line
        REFUSED,  ///< refusal() says why, and which line can
    };
    /// A line of the main program, from 1 on.
    BlockSearch(gcode::Interpreter &interpreter, CanonSwitch &machine, const SearchMachine::Real &real,
                int line);
    /// A block, as TaskCanon counts them, from 1 on: calls from it on have reached the machine's queue. The
    /// program finds what `set_up` has brought about.
    struct Block {
        std::uint32_t number = 0;
        /// Checksum of all that must have been asked for before it; nothing: whatever it is.
        std::optional<std::uint64_t> calls;
        std::vector<gcode::MachineCall> set_up;
    };
    BlockSearch(gcode::Interpreter &interpreter, CanonSwitch &machine, const SearchMachine::Real &real,
                const Block &block);
    ~BlockSearch();
    BlockSearch(const BlockSearch &) = delete;
    BlockSearch &operator=(const BlockSearch &) = delete;

    /// Runs so many lines at most.
    Outcome step(int lines);
    const std::string &refusal() const { return refusal_; }
    /// As of the place that was found.
    FoundModes found() const { return machine_.found(); }
    const std::map<int, gcode::ToolEntry> &tool_entries() const { return machine_.tool_entries(); }
    /// That come before it.
    std::uint32_t blocks_before() const { return machine_.blocks(); }
    const ProgramChecksum &sum() const { return machine_.sum(); }
    /// How the step ended that has come there; what it asks for is still to be done.
    gcode::Step last_step() const { return last_step_; }

  private:
    Outcome look_at_line();
    Outcome run_line();
    Outcome check_calls();
    Outcome refuse(const std::string &why);
    Outcome refuse_before(const std::string &why);

    gcode::Interpreter &interpreter_;
    CanonSwitch &switch_;
    SearchMachine machine_;
    int line_ = 0;  ///< 0: a block is looked for
    std::optional<std::uint64_t> calls_;
    gcode::Step last_step_ = gcode::Step::OK;
    bool wasThreading_ = false;  ///< before that step
    int last_possible_ = 0;      ///< a start there would have been possible, 0: none yet
    int first_behind_ = 0;       ///< the first line behind the wanted one that is reached, 0: none
    std::string doubt_;          ///< with its line
    std::string refusal_;
};

}  // namespace mw::task

// SPDX-License-Identifier: GPL-2.0-or-later
// Calculates a program up to the position where it starts, without moving anything.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>

#include "gcode/interpreter/interpreter.hh"
#include "machine/task/run/canon_switch.hh"

namespace mw::task {

/// One thread; the argument of step() limits its work.
class BlockSearch {
  public:
    enum class Outcome : std::uint8_t {
        GOING,
        FOUND,    ///< the next step of the interpreter runs the line
        REFUSED,  ///< `refusal` has the reason and a possible line
    };
    /// `line` of the main program, from 1.
    BlockSearch(gcode::Interpreter &interpreter, CanonSwitch &machine, const SearchMachine::Real &real,
                int line);
    /// A block, by its number in TaskCanon, from 1. Calls from this block on have reached the machine's
    /// queue. The program starts with the state after `set_up`.
    struct Block {
        std::uint32_t number = 0;
        /// Expected checksum of all calls before it; nothing: not compared.
        std::optional<std::uint64_t> calls;
        std::vector<gcode::MachineCall> set_up;
    };
    BlockSearch(gcode::Interpreter &interpreter, CanonSwitch &machine, const SearchMachine::Real &real,
                const Block &block);
    ~BlockSearch();
    BlockSearch(const BlockSearch &) = delete;
    BlockSearch &operator=(const BlockSearch &) = delete;

    /// Runs at most this number of lines.
    Outcome step(int lines);
    const std::string &refusal() const { return refusal_; }
    /// State at the position that was found.
    FoundModes found() const { return machine_.found(); }
    const std::map<int, gcode::ToolEntry> &tool_entries() const { return machine_.tool_entries(); }
    /// Number of blocks before it.
    std::uint32_t blocks_before() const { return machine_.blocks(); }
    const ProgramChecksum &sum() const { return machine_.sum(); }
    /// Result of the step that reached the position; the machine must still execute its calls.
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
    int line_ = 0;  ///< 0: searching a block
    std::optional<std::uint64_t> calls_;
    gcode::Step last_step_ = gcode::Step::OK;
    bool was_threading_ = false;  ///< threading before that step
    int last_possible_ = 0;       ///< last line at which a start would have been possible, 0: none yet
    int first_behind_ = 0;        ///< the first line after the target that is reached, 0: none
    std::string doubt_;           ///< includes its line
    std::string refusal_;
};

}  // namespace mw::task

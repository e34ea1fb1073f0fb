// SPDX-License-Identifier: GPL-2.0-or-later
#include "machine/task/run/block_search.hh"

#include <algorithm>

#include <fmt/format.h>

#include "gcode/interpreter/interpreter_state.hh"

namespace mw::task {

BlockSearch::BlockSearch(gcode::Interpreter &interpreter, CanonSwitch &machine,
                         const SearchMachine::Real &real, int line)
    : interpreter_(interpreter), switch_(machine), machine_(real), line_(line) {
    switch_.set_search(&machine_);
    interpreter_.limits().are_scripts_forbidden = true;
}

BlockSearch::BlockSearch(gcode::Interpreter &interpreter, CanonSwitch &machine,
                         const SearchMachine::Real &real, const Block &block)
    : interpreter_(interpreter), switch_(machine), machine_(real), calls_(block.calls) {
    machine_.set_up(block.set_up);
    switch_.set_search(&machine_, block.number);
    interpreter_.limits().are_scripts_forbidden = true;
}

BlockSearch::~BlockSearch() {
    switch_.set_search(nullptr);
    interpreter_.limits().are_scripts_forbidden = false;
}

BlockSearch::Outcome BlockSearch::step(int lines) {
    Outcome outcome = Outcome::GOING;
    for (int i = 0; i < lines && outcome == Outcome::GOING; ++i) {
        outcome = look_at_line();
        outcome = outcome == Outcome::GOING ? run_line() : outcome;
    }
    return outcome;
}

BlockSearch::Outcome BlockSearch::refuse(const std::string &why) {
    refusal_ = why;
    return Outcome::REFUSED;
}

BlockSearch::Outcome BlockSearch::refuse_before(const std::string &why) {
    const int nearest = last_possible_ > 0 ? last_possible_ : 1;
    return refuse(fmt::format("{}; the nearest possible line before it is {}", why, nearest));
}

/// Called before the line is run.
BlockSearch::Outcome BlockSearch::look_at_line() {
    const gcode::NextLine next = interpreter_.next_line();
    const bool matching = line_ > 0 && next.line == line_ && next.in_main_file;
    if (next.in_call) {
        return matching ? refuse_before(
                              fmt::format("line {} is in subroutine o<{}>, whose first call is in line {}",
                                          line_, interpreter_.subroutine(), next.main_line))
                        : Outcome::GOING;
    }
    const std::string why = interpreter_.state().why_no_start();
    was_threading_ = interpreter_.state().isThreading();
    if (matching) {
        return !doubt_.empty()
                   ? refuse_before(fmt::format("the state at line {} depends on {}", line_, doubt_))
               : !why.empty() ? refuse_before(fmt::format("no program can start at line {}: {}", line_, why))
                              : Outcome::FOUND;
    }
    last_possible_ = why.empty() && doubt_.empty() ? next.line : last_possible_;
    return Outcome::GOING;
}

/// Checks that the calculated calls are those that the machine has executed.
BlockSearch::Outcome BlockSearch::check_calls() {
    if (was_threading_ && interpreter_.state().isThreading()) {
        return refuse_before("it is in the middle of moves that follow the spindle");
    }
    return !calls_.has_value() || machine_.sum().value() == *calls_
               ? Outcome::FOUND
               : refuse("the program differs from the interrupted run: a subroutine, the INI file or an "
                        "input has changed since. Run it from a line");
}

BlockSearch::Outcome BlockSearch::run_line() {
    const gcode::Step step = interpreter_.step();
    if (doubt_.empty() && !machine_.doubt().empty()) {
        doubt_ = fmt::format("{} in line {}", machine_.doubt(), interpreter_.line());
    }
    last_step_ = step;
    if (switch_.isPassing()) {
        return doubt_.empty() ? check_calls()
                              : refuse_before("the state at the interrupted line depends on " + doubt_);
    }
    switch (step) {
    case gcode::Step::OK: break;
    case gcode::Step::SYNC: interpreter_.synch(); break;
    case gcode::Step::FAILED: return refuse_before(interpreter_.error().str());
    case gcode::Step::PROGRAM_END:
    case gcode::Step::FILE_END:
        if (line_ == 0) {
            return refuse("the program ends before the line where it was interrupted");
        }
        return first_behind_ > 0
                   ? refuse(fmt::format("line {} is never reached; the next line that is reached is {}",
                                        line_, first_behind_))
                   : refuse_before(fmt::format("line {} is never reached", line_));
    }
    const gcode::NextLine next = interpreter_.next_line();
    if (!next.in_call && next.line > line_ && line_ > 0) {
        first_behind_ = first_behind_ == 0 ? next.line : std::min(first_behind_, next.line);
    }
    return Outcome::GOING;
}

}  // namespace mw::task

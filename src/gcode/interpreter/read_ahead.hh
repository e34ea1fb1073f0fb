// SPDX-License-Identifier: GPL-2.0-or-later
// States of the interpreter after steps that the machine may not have reached: an abort returns to the
// executed step.
#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <string>
#include <vector>

#include "gcode/interpreter/interpreter_state.hh"

namespace mw::gcode {

namespace detail {
class Executor;
class Flow;
}  // namespace detail

/// Stores the state at the executed step, and the changes of each later step. Step numbers never decrease.
/// All calls come from one thread.
class ReadAhead {
  public:
    /// Both objects must outlive the read-ahead.
    ReadAhead(detail::Executor &executor, detail::Flow &flow) : executor_(executor), flow_(flow) {}

    /// Begins recording the changes of later steps; everything read so far is executed.
    void begin();
    /// Ends recording until the next begin().
    void stop();
    /// Stores the current state as the state after step `number`.
    void note(std::uint64_t number);
    /// The machine has reached step `number`.
    void mark_executed(std::uint64_t number);
    /// Restores modes, offsets and parameters of the executed step; calls and loops end.
    void return_to_executed();
    ActiveCodes executed_codes() const { return executed_->active_codes(0); }
    /// Content of the parameter file at the executed step.
    std::string parameter_text() const;
    /// True if the last line has no words: it is blank, only a comment, or skipped.
    bool isLineEmpty() const;

  private:
    struct Entry {
        std::uint64_t number = 0;
        detail::State modes;
        detail::ReturnValue returned;
        detail::BlockCodes block_codes;
        std::shared_ptr<const detail::SavedModes> saved_modes;  ///< null: unchanged by the step
        std::vector<detail::ParameterChange> changes;
    };
    bool isRecording() const { return executed_ != nullptr; }

    detail::Executor &executor_;
    detail::Flow &flow_;
    std::unique_ptr<InterpreterState> executed_;
    std::deque<Entry> entries_;
    std::uint64_t modes_revision_ = 0;  ///< revision of the last stored saved modes
};

}  // namespace mw::gcode

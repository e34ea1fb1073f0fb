// SPDX-License-Identifier: GPL-2.0-or-later
// States of the interpreter after steps that the machine may not have reached: an abort returns to the
// executed step.
#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <string>
#include <vector>

#include "gcode/interpreter/flow/flow.hh"
#include "gcode/interpreter/interpreter_snapshot.hh"

namespace mw::gcode::detail {

Interpreter::Snapshot snapshot(const Executor &executor);
void restore(const Interpreter::Snapshot &kept, Executor &executor);

/// Stores the state at the executed step, and the changes of each later step.
class BlockHistory final : public ReadAhead {
  public:
    /// Both must outlive the history.
    BlockHistory(Executor &executor, Flow &flow) : executor_(executor), flow_(flow) {}

    void begin() override;
    void stop() override;
    void note(std::uint64_t number) override;
    void mark_executed(std::uint64_t number) override;
    void return_to_executed() override;
    ActiveCodes executed_codes() const override;
    std::string parameter_text() const override;
    bool isLineEmpty() const override { return flow_.isLineEmpty(); }

  private:
    struct Entry {
        std::uint64_t number = 0;
        State state;
        ReturnValue returned;
        BlockCodes block_codes;
        std::shared_ptr<const SavedModes> saved_modes;  ///< null: unchanged by the step
        std::vector<ParameterChange> changes;
    };
    bool isRecording() const { return executed_ != nullptr; }

    Executor &executor_;
    Flow &flow_;
    std::unique_ptr<Interpreter::Snapshot> executed_;
    std::deque<Entry> entries_;
    std::uint64_t modes_revision_ = 0;  ///< revision of the last stored saved modes
};

}  // namespace mw::gcode::detail

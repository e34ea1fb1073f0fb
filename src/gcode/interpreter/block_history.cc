// SPDX-License-Identifier: GPL-2.0-or-later
#include "gcode/interpreter/block_history.hh"

namespace mw::gcode::detail {

Interpreter::Snapshot snapshot(const Executor &executor) {
    return {executor.state, executor.parameters, executor.saved_modes, executor.returned,
            executor.block_codes};
}

void restore(const Interpreter::Snapshot &kept, Executor &executor) {
    executor.state = kept.state;
    executor.parameters = kept.parameters;
    executor.saved_modes = kept.saved_modes;
    executor.returned = kept.returned;
    executor.block_codes = kept.block_codes;
    executor.tools.forget();
    executor.awaited = {};
}

void BlockHistory::begin() {
    executor_.parameters.record_changes(false);
    executed_ = std::make_unique<Interpreter::Snapshot>(snapshot(executor_));
    executor_.parameters.record_changes(true);
    entries_.clear();
    modes_revision_ = executor_.saved_modes.revision();
}

void BlockHistory::stop() {
    executor_.parameters.record_changes(false);
    executed_.reset();
    entries_.clear();
}

void BlockHistory::note(std::uint64_t number) {
    if (!isRecording()) {
        return;
    }
    if (entries_.empty() || entries_.back().number != number) {
        entries_.emplace_back().number = number;
    }
    Entry &entry = entries_.back();
    entry.state = executor_.state;
    entry.returned = executor_.returned;
    entry.block_codes = executor_.block_codes;
    executor_.parameters.take_changes(entry.changes);
    if (executor_.saved_modes.revision() != modes_revision_) {
        modes_revision_ = executor_.saved_modes.revision();
        entry.saved_modes = std::make_shared<const SavedModes>(executor_.saved_modes);
    }
}

void BlockHistory::mark_executed(std::uint64_t number) {
    for (; !entries_.empty() && entries_.front().number <= number; entries_.pop_front()) {
        const Entry &entry = entries_.front();
        executed_->state = entry.state;
        executed_->returned = entry.returned;
        executed_->block_codes = entry.block_codes;
        for (const ParameterChange &change : entry.changes) {
            executed_->parameters.apply(change);
        }
        if (entry.saved_modes != nullptr) {
            executed_->saved_modes = *entry.saved_modes;
        }
    }
}

/// The calls of the executed step end with the program, as do calls that were read later.
void BlockHistory::return_to_executed() {
    flow_.abort();
    if (!isRecording()) {
        return;
    }
    restore(*executed_, executor_);
    while (executor_.parameters.depth() > 1) {
        executor_.parameters.pop_call(false);
    }
    executor_.saved_modes.drop_calls(0);
    executor_.abort_block();
    executor_.state.comp = {};  // the next move is not compensated
    begin();
}

ActiveCodes BlockHistory::executed_codes() const {
    return active_codes(executed_->state, executed_->parameters, executed_->block_codes, 0);
}

std::string BlockHistory::parameter_text() const {
    return (isRecording() ? executed_->parameters : executor_.parameters).text();
}

}  // namespace mw::gcode::detail

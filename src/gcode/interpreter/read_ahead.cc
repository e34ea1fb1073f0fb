// SPDX-License-Identifier: GPL-2.0-or-later
#include "gcode/interpreter/read_ahead.hh"

#include "gcode/interpreter/flow/flow.hh"

namespace mw::gcode {

void ReadAhead::begin() {
    executor_.parameters.record_changes(false);
    executed_ = std::make_unique<InterpreterState>(executor_);
    executor_.parameters.record_changes(true);
    entries_.clear();
    modes_revision_ = executor_.saved_modes.revision();
}

void ReadAhead::stop() {
    executor_.parameters.record_changes(false);
    executed_.reset();
    entries_.clear();
}

void ReadAhead::note(std::uint64_t number) {
    if (!isRecording()) {
        return;
    }
    if (entries_.empty() || entries_.back().number != number) {
        entries_.emplace_back().number = number;
    }
    Entry &entry = entries_.back();
    entry.modes = executor_.modes;
    entry.returned = executor_.returned;
    entry.block_codes = executor_.block_codes;
    executor_.parameters.take_changes(entry.changes);
    if (executor_.saved_modes.revision() != modes_revision_) {
        modes_revision_ = executor_.saved_modes.revision();
        entry.saved_modes = std::make_shared<const detail::SavedModes>(executor_.saved_modes);
    }
}

void ReadAhead::mark_executed(std::uint64_t number) {
    for (; !entries_.empty() && entries_.front().number <= number; entries_.pop_front()) {
        const Entry &entry = entries_.front();
        executed_->modes = entry.modes;
        executed_->returned = entry.returned;
        executed_->block_codes = entry.block_codes;
        for (const detail::ParameterChange &change : entry.changes) {
            executed_->parameters.apply(change);
        }
        if (entry.saved_modes != nullptr) {
            executed_->saved_modes = *entry.saved_modes;
        }
    }
}

/// The calls of the executed step, and all later ones, end with the program.
void ReadAhead::return_to_executed() {
    flow_.abort();
    if (!isRecording()) {
        return;
    }
    executor_.restore(*executed_);
    while (executor_.parameters.depth() > 1) {
        executor_.parameters.pop_call(false);
    }
    executor_.saved_modes.drop_calls(0);
    executor_.abort_block();
    executor_.modes.comp = {};  // the next move is not compensated
    begin();
}

std::string ReadAhead::parameter_text() const {
    return (isRecording() ? executed_->parameters : executor_.parameters).text();
}

bool ReadAhead::isLineEmpty() const {
    return flow_.isLineEmpty();
}

}  // namespace mw::gcode

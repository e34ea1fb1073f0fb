// SPDX-License-Identifier: GPL-2.0-or-later
#include "machine/io/discrete_io.hh"

#include <algorithm>
#include <cmath>
#include <utility>

namespace mw::io {

ToolEvent DiscreteIo::step(const Inputs &inputs) {
    step_chain(inputs);
    has_oil_ = inputs.lube_level;
    tool_offset_shown_ = inputs.tool_offset_shown;
    step_fault(inputs);
    step_abort(inputs);
    outputs.state = action_ == ToolAction::IDLE ? 0 : 1;
    const ToolEvent event = step_handshake(inputs);
    return event == ToolEvent::NONE && isLate(inputs) ? ToolEvent::CHANGED_LATE : event;
}

void DiscreteIo::step_chain(const Inputs &inputs) {
    chain_closed_ = inputs.emc_enable_in;
    outputs.user_request_enable = std::exchange(request_pulse_due_, false);
    if (lube_due_ && chain_closed_) {
        outputs.lube = true;
        lube_due_ = false;
    }
}

void DiscreteIo::step_fault(const Inputs &inputs) {
    if (inputs.toolchanger_fault) {
        fault_reason_ = inputs.toolchanger_reason;
        outputs.toolchanger_faulted = true;
    } else if (!protocol_.is_version2 || inputs.toolchanger_clear_fault) {
        outputs.toolchanger_faulted = false;
    }
    outputs.toolchanger_fault_ack = inputs.toolchanger_fault;
}

void DiscreteIo::step_abort(const Inputs &inputs) {
    if (std::exchange(abort_pulse_due_, false)) {
        outputs.emc_abort = true;
        return;
    }
    const bool answered = !protocol_.is_version2 || inputs.emc_abort_ack;
    if (!outputs.emc_abort || !answered) {
        return;
    }
    outputs.emc_abort = false;
    outputs.emc_reason = 0;
    action_ = action_ == ToolAction::ABORTING ? ToolAction::IDLE : action_;
}

ToolEvent DiscreteIo::end_by_fault() {
    const bool continuing = protocol_.is_version2 && fault_reason_ > 0;
    abort(REASON_CHANGER_FAULT);
    abandoned_ = false;  // the changer reports that no change is under way
    return continuing ? ToolEvent::FAULT_TOLD : ToolEvent::FAULT;
}

ToolEvent DiscreteIo::step_handshake(const Inputs &inputs) {
    if (action_ == ToolAction::IDLE || action_ == ToolAction::ABORTING) {
        return ToolEvent::NONE;
    }
    if (outputs.toolchanger_faulted) {
        return end_by_fault();
    }
    if (action_ == ToolAction::STARTING) {
        if (outputs.start_change && inputs.start_change_ack) {
            outputs.start_change = false;
            action_ = ToolAction::CHANGING;
        }
        return ToolEvent::NONE;
    }
    const bool preparing = action_ == ToolAction::PREPARING;
    bool &request = preparing ? outputs.tool_prepare : outputs.tool_change;
    const bool answered = preparing ? inputs.tool_prepared : inputs.tool_changed;
    if (!request) {
        // A pending answer belongs to the previous handshake, so the request waits for its end.
        request = !answered;
        return ToolEvent::NONE;
    }
    if (!answered) {
        return ToolEvent::NONE;
    }
    request = false;
    action_ = ToolAction::IDLE;
    return preparing ? ToolEvent::PREPARED : ToolEvent::CHANGED;
}

/// True if the changer completed the change after it was aborted. The operator must then enter the loaded
/// tool.
bool DiscreteIo::isLate(const Inputs &inputs) {
    return abandoned_ && inputs.tool_changed && std::exchange(abandoned_, false);
}

void DiscreteIo::enter_estop() {
    outputs.user_enable_out = false;
    outputs.lube = false;
    lube_due_ = false;
    request_pulse_due_ = false;
}

void DiscreteIo::leave_estop() {
    outputs.user_enable_out = true;
    outputs.toolchanger_faulted = false;  // until the changer reports a fault again
    request_pulse_due_ = true;
    lube_due_ = true;
}

void DiscreteIo::start_prepare(int number, int pocket, int index) {
    outputs.tool_prep_number = number;
    outputs.tool_prep_pocket = pocket;
    outputs.tool_prep_index = index;
    action_ = ToolAction::PREPARING;
}

void DiscreteIo::start_change() {
    abandoned_ = false;
    outputs.start_change = protocol_.has_start_change;
    action_ = protocol_.has_start_change ? ToolAction::STARTING : ToolAction::CHANGING;
}

void DiscreteIo::clear_prepared() {
    outputs.tool_prep_number = outputs.tool_prep_pocket = outputs.tool_prep_index = 0;
}

void DiscreteIo::abort(int reason) {
    const bool active = action_ != ToolAction::IDLE;
    if (action_ == ToolAction::ABORTING || (!active && !protocol_.is_version2)) {
        return;
    }
    abandoned_ = abandoned_ || outputs.tool_change;
    abort_pulse_due_ = true;
    outputs.emc_reason = reason;
    outputs.tool_prepare = false;
    outputs.tool_change = false;
    outputs.start_change = false;
    action_ = protocol_.is_version2 ? ToolAction::ABORTING : ToolAction::IDLE;
}

messages::WaitFor DiscreteIo::waiting_for() const {
    switch (action_) {
    case ToolAction::IDLE: break;
    case ToolAction::PREPARING:
        return outputs.tool_prepare ? messages::WaitFor::TOOL_PREPARED : messages::WaitFor::TOOL_PREPARED_OFF;
    case ToolAction::STARTING: return messages::WaitFor::TOOL_START_CHANGE;
    case ToolAction::CHANGING:
        return outputs.tool_change ? messages::WaitFor::TOOL_CHANGED : messages::WaitFor::TOOL_CHANGED_OFF;
    case ToolAction::ABORTING: return messages::WaitFor::TOOL_ABORT_TAKEN;
    }
    return messages::WaitFor::NOTHING;
}

void DiscreteIo::set_tool_in_spindle(int number, int from_pocket) {
    outputs.tool_number = number;
    outputs.tool_from_pocket = from_pocket;
}

void DiscreteIo::set_tool_offset(const geometry::Pose &offset) {
    const bool finite = std::ranges::all_of(offset.c, [](double length) { return std::isfinite(length); });
    if (finite && offset.c != outputs.tool_offset.c) {
        outputs.tool_offset = offset;
        tool_offset_shown_ = false;
    }
}

}  // namespace mw::io

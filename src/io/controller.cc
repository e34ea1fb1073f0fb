// SPDX-License-Identifier: GPL-2.0-or-later
#include "io/controller.hh"

namespace mw::io {

ToolEvent Controller::step(const Inputs &inputs) {
    isChainClosed_ = inputs.emc_enable_in;
    outputs.user_request_enable = mustPulseRequest_;
    mustPulseRequest_ = false;
    outputs.emc_abort = mustPulseAbort_;
    mustPulseAbort_ = false;
    outputs.state = action_ == ToolAction::IDLE ? 0 : 1;
    return step_handshake(inputs);
}

ToolEvent Controller::step_handshake(const Inputs &inputs) {
    if (action_ == ToolAction::IDLE) {
        return ToolEvent::NONE;
    }
    if (inputs.toolchanger_fault) {
        fault_reason_ = inputs.toolchanger_reason;
        abort();
        return ToolEvent::FAULT;
    }
    const bool isPreparing = action_ == ToolAction::PREPARING;
    bool &request = isPreparing ? outputs.tool_prepare : outputs.tool_change;
    const bool isAnswered = isPreparing ? inputs.tool_prepared : inputs.tool_changed;
    if (!request) {
        // An answer that is still on belongs to the handshake before.
        request = !isAnswered;
        return ToolEvent::NONE;
    }
    if (!isAnswered) {
        return ToolEvent::NONE;
    }
    request = false;
    action_ = ToolAction::IDLE;
    return isPreparing ? ToolEvent::PREPARED : ToolEvent::CHANGED;
}

void Controller::enter_estop() {
    outputs.user_enable_out = false;
    mustPulseRequest_ = false;
}

void Controller::leave_estop() {
    outputs.user_enable_out = true;
    mustPulseRequest_ = true;
}

void Controller::start_prepare(int number, int pocket, int index) {
    outputs.tool_prep_number = number;
    outputs.tool_prep_pocket = pocket;
    outputs.tool_prep_index = index;
    action_ = ToolAction::PREPARING;
}

void Controller::start_change() {
    action_ = ToolAction::CHANGING;
}

void Controller::abort() {
    if (action_ != ToolAction::IDLE) {
        mustPulseAbort_ = true;
    }
    outputs.tool_prepare = false;
    outputs.tool_change = false;
    action_ = ToolAction::IDLE;
}

msgs::WaitFor Controller::waiting_for() const {
    switch (action_) {
    case ToolAction::IDLE: break;
    case ToolAction::PREPARING:
        return outputs.tool_prepare ? msgs::WaitFor::TOOL_PREPARED : msgs::WaitFor::TOOL_PREPARED_OFF;
    case ToolAction::CHANGING:
        return outputs.tool_change ? msgs::WaitFor::TOOL_CHANGED : msgs::WaitFor::TOOL_CHANGED_OFF;
    }
    return msgs::WaitFor::NOTHING;
}

void Controller::set_tool_in_spindle(int number, int from_pocket) {
    outputs.tool_number = number;
    outputs.tool_from_pocket = from_pocket;
}

}  // namespace mw::io

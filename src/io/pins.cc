// SPDX-License-Identifier: GPL-2.0-or-later
#include "io/pins.hh"

namespace mw::io {

Result<> Pins::create(hal::Hal &hal) {
    const auto id = hal.new_component("iocontrol");
    if (!id.has_value()) {
        return std::unexpected(id.error());
    }
    hal_ = &hal;
    comp_id_ = *id;
    auto status = make_inputs(hal);
    if (status.has_value()) {
        status = make_outputs(hal);
    }
    if (status.has_value()) {
        lube_level_ = true;
        status = hal.set_ready(comp_id_);
    }
    if (!status.has_value()) {
        destroy();
    }
    return status;
}

Result<> Pins::make_inputs(hal::Hal &hal) {
    Result<> status;
    const auto in = [&](auto &pin, const char *name) {
        pin.make(hal, comp_id_, std::string("iocontrol.0.") + name, hal::Dir::IN, status);
    };
    in(emc_enable_in_, "emc-enable-in");
    in(tool_prepared_, "tool-prepared");
    in(tool_changed_, "tool-changed");
    in(lube_level_, "lube_level");
    in(toolchanger_fault_, "toolchanger-fault");
    in(fault_ack_, "toolchanger-fault-ack");
    in(toolchanger_reason_, "toolchanger-reason");
    return status;
}

Result<> Pins::make_outputs(hal::Hal &hal) {
    Result<> status;
    const auto out = [&](auto &pin, const char *name) {
        pin.make(hal, comp_id_, std::string("iocontrol.0.") + name, hal::Dir::OUT, status);
    };
    out(user_enable_out_, "user-enable-out");
    out(user_request_enable_, "user-request-enable");
    out(coolant_mist_, "coolant-mist");
    out(coolant_flood_, "coolant-flood");
    out(lube_, "lube");
    out(tool_prepare_, "tool-prepare");
    out(tool_change_, "tool-change");
    out(emc_abort_, "emc-abort");
    out(toolchanger_faulted_, "toolchanger-faulted");
    out(tool_prep_number_, "tool-prep-number");
    out(tool_prep_pocket_, "tool-prep-pocket");
    out(tool_prep_index_, "tool-prep-index");
    out(tool_number_, "tool-number");
    out(tool_from_pocket_, "tool-from-pocket");
    out(state_, "state");
    return status;
}

void Pins::destroy() {
    if (hal_ != nullptr) {
        static_cast<void>(hal_->delete_component(comp_id_));
        hal_ = nullptr;
    }
}

Inputs Pins::read() const {
    Inputs inputs;
    inputs.emc_enable_in = emc_enable_in_;
    inputs.tool_prepared = tool_prepared_;
    inputs.tool_changed = tool_changed_;
    inputs.lube_level = lube_level_;
    inputs.toolchanger_fault = toolchanger_fault_;
    inputs.toolchanger_reason = toolchanger_reason_;
    return inputs;
}

void Pins::write(const Outputs &outputs) {
    user_enable_out_ = outputs.user_enable_out;
    user_request_enable_ = outputs.user_request_enable;
    coolant_mist_ = outputs.coolant_mist;
    coolant_flood_ = outputs.coolant_flood;
    lube_ = outputs.lube;
    tool_prepare_ = outputs.tool_prepare;
    tool_change_ = outputs.tool_change;
    emc_abort_ = outputs.emc_abort;
    toolchanger_faulted_ = toolchanger_fault_;
    tool_prep_number_ = outputs.tool_prep_number;
    tool_prep_pocket_ = outputs.tool_prep_pocket;
    tool_prep_index_ = outputs.tool_prep_index;
    tool_number_ = outputs.tool_number;
    tool_from_pocket_ = outputs.tool_from_pocket;
    state_ = outputs.state;
}

}  // namespace mw::io

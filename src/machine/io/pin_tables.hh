// SPDX-License-Identifier: GPL-2.0-or-later
// Every pin of the I/O controller, declared once: what is made in HAL, what is copied each task cycle, and
// the pins of iocontrol(1) follow from here.
#pragma once

#include "hal/sdk/pin_table.hh"
#include "machine/io/discrete_io.hh"

namespace mw::io {

/// What rows read into.
struct PinInputs {
    Inputs in;
};
/// What rows write from.
struct PinOutputs {
    const Outputs &out;
};

namespace pins {

using sdk::in, sdk::out, sdk::pin_table;
using Count = std::int32_t;

// clang-format off
inline constexpr auto IOCONTROL = pin_table("iocontrol.0",
    in<bool>("emc-enable-in", "", "the emergency stop chain is closed; FALSE stops the machine, in the servo thread too", [](PinInputs &p, bool v) { p.in.emc_enable_in = v; }),
    in<bool>("tool-prepared", "", "the answer to tool-prepare", [](PinInputs &p, bool v) { p.in.tool_prepared = v; }),
    in<bool>("tool-changed", "", "the answer to tool-change", [](PinInputs &p, bool v) { p.in.tool_changed = v; }),
    in<bool>("lube_level", "", "the oil level is sufficient; FALSE is shown and reported", [](PinInputs &p, bool v) { p.in.lube_level = v; }, true),
    in<bool>("toolchanger-fault", "", "the changer has failed: ends its request and the program", [](PinInputs &p, bool v) { p.in.toolchanger_fault = v; }),
    in<bool>("toolchanger-clear-fault", "", "with EMCIO = iov2: clears a past fault", [](PinInputs &p, bool v) { p.in.toolchanger_clear_fault = v; }),
    in<bool>("emc-abort-ack", "", "with EMCIO = iov2: the required answer to emc-abort", [](PinInputs &p, bool v) { p.in.emc_abort_ack = v; }),
    in<bool>("start-change-ack", "", "with EMCIO = iov2 -support-start-change: the answer to start-change", [](PinInputs &p, bool v) { p.in.start_change_ack = v; }),
    in<Count>("toolchanger-reason", "", "why the changer has failed: #5601 of programs", [](PinInputs &p, Count v) { p.in.toolchanger_reason = v; }),
    out<bool>("user-enable-out", "", "a person has released the emergency stop", [](const PinOutputs &p) { return p.out.user_enable_out; }),
    out<bool>("user-request-enable", "", "a pulse that resets a latch", [](const PinOutputs &p) { return p.out.user_request_enable; }),
    out<bool>("coolant-mist", "", "M7", [](const PinOutputs &p) { return p.out.coolant_mist; }),
    out<bool>("coolant-flood", "", "M8", [](const PinOutputs &p) { return p.out.coolant_flood; }),
    out<bool>("lube", "", "on once the emergency stop is reset, and by LubeOn; off in emergency stop", [](const PinOutputs &p) { return p.out.lube; }),
    out<bool>("tool-prepare", "", "T: requests the tool of the tool-prep pins until it is prepared", [](const PinOutputs &p) { return p.out.tool_prepare; }),
    out<bool>("tool-change", "", "M6: requests the change until it is done", [](const PinOutputs &p) { return p.out.tool_change; }),
    out<bool>("emc-abort", "", "a pulse, with EMCIO = iov2 until it is answered: requests to the changer are aborted", [](const PinOutputs &p) { return p.out.emc_abort; }),
    out<Count>("emc-reason", "", "reason of the abort: 1 to 10 as #1 of ON_ABORT_COMMAND, 101 a fault of the changer", [](const PinOutputs &p) { return p.out.emc_reason; }),
    out<bool>("start-change", "", "M6 begins: with EMCIO = iov2 -support-start-change, until it is answered", [](const PinOutputs &p) { return p.out.start_change; }),
    out<bool>("toolchanger-fault-ack", "", "toolchanger-fault and its reason have been read", [](const PinOutputs &p) { return p.out.toolchanger_fault_ack; }),
    out<bool>("toolchanger-faulted", "", "the changer has failed; with EMCIO = iov2 until it is cleared", [](const PinOutputs &p) { return p.out.toolchanger_faulted; }),
    out<Count>("tool-prep-number", "", "number of the requested tool", [](const PinOutputs &p) { return p.out.tool_prep_number; }),
    out<Count>("tool-prep-pocket", "", "its pocket", [](const PinOutputs &p) { return p.out.tool_prep_pocket; }),
    out<Count>("tool-prep-index", "", "its index in the tool table", [](const PinOutputs &p) { return p.out.tool_prep_index; }),
    out<Count>("tool-number", "", "the tool in the spindle, 0 none", [](const PinOutputs &p) { return p.out.tool_number; }),
    out<Count>("tool-from-pocket", "", "its pocket", [](const PinOutputs &p) { return p.out.tool_from_pocket; }),
    out<Count>("state", "", "0: no request to the changer, 1: a request is active", [](const PinOutputs &p) { return p.out.state; }));
// clang-format on

/// Calls `show(scope, row)` for every pin.
template <class Show>
void for_each(Show &&show) {
    sdk::for_each_pin(IOCONTROL, show);
}

}  // namespace pins
}  // namespace mw::io

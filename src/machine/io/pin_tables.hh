// SPDX-License-Identifier: GPL-2.0-or-later
// All pins of the I/O controller, declared once. The tables generate the pins in HAL, the transfer in each
// task cycle, and the list of pins in iocontrol(1).
#pragma once

#include "hal/sdk/pin_table.hh"
#include "machine/io/discrete_io.hh"

namespace mw::io {

/// Destination of the rows that read.
struct PinInputs {
    Inputs in;
};
/// Source of the rows that write.
struct PinOutputs {
    const Outputs &out;
};

namespace pins {

using sdk::in, sdk::out, sdk::pin_table;
using Count = std::int32_t;

// clang-format off
inline constexpr auto IOCONTROL = pin_table("iocontrol.0",
    in<bool>("emc-enable-in", "", "TRUE if the emergency stop chain is closed; FALSE stops the machine, also in the servo thread", [](PinInputs &p, bool v) { p.in.emc_enable_in = v; }),
    in<bool>("tool-prepared", "", "the changer has prepared the tool", [](PinInputs &p, bool v) { p.in.tool_prepared = v; }),
    in<bool>("tool-changed", "", "the tool change is done", [](PinInputs &p, bool v) { p.in.tool_changed = v; }),
    in<bool>("lube_level", "", "TRUE if the oil level is sufficient; FALSE causes a message", [](PinInputs &p, bool v) { p.in.lube_level = v; }, true),
    in<bool>("toolchanger-fault", "", "fault of the changer: ends the request and the program", [](PinInputs &p, bool v) { p.in.toolchanger_fault = v; }),
    in<bool>("toolchanger-clear-fault", "", "with EMCIO = iov2: clears an old fault", [](PinInputs &p, bool v) { p.in.toolchanger_clear_fault = v; }),
    in<bool>("emc-abort-ack", "", "with EMCIO = iov2: acknowledges emc-abort", [](PinInputs &p, bool v) { p.in.emc_abort_ack = v; }),
    in<bool>("start-change-ack", "", "with EMCIO = iov2 -support-start-change: acknowledges start-change", [](PinInputs &p, bool v) { p.in.start_change_ack = v; }),
    in<Count>("toolchanger-reason", "", "reason of a fault of the changer; #5601 in programs", [](PinInputs &p, Count v) { p.in.toolchanger_reason = v; }),
    out<bool>("user-enable-out", "", "TRUE if the operator has reset the emergency stop", [](const PinOutputs &p) { return p.out.user_enable_out; }),
    out<bool>("user-request-enable", "", "pulse that resets the emergency stop latch", [](const PinOutputs &p) { return p.out.user_request_enable; }),
    out<bool>("coolant-mist", "", "mist coolant (M7)", [](const PinOutputs &p) { return p.out.coolant_mist; }),
    out<bool>("coolant-flood", "", "flood coolant (M8)", [](const PinOutputs &p) { return p.out.coolant_flood; }),
    out<bool>("lube", "", "lubrication: on after the reset of the emergency stop and by LubeOn; off in emergency stop", [](const PinOutputs &p) { return p.out.lube; }),
    out<bool>("tool-prepare", "", "requests the tool of the tool-prep pins (T), until it is prepared", [](const PinOutputs &p) { return p.out.tool_prepare; }),
    out<bool>("tool-change", "", "requests the tool change (M6), until it is done", [](const PinOutputs &p) { return p.out.tool_change; }),
    out<bool>("emc-abort", "", "aborts requests to the changer: a pulse; with EMCIO = iov2 until it is acknowledged", [](const PinOutputs &p) { return p.out.emc_abort; }),
    out<Count>("emc-reason", "", "reason of the abort: 1 to 10 as #1 of ON_ABORT_COMMAND, 101 a fault of the changer", [](const PinOutputs &p) { return p.out.emc_reason; }),
    out<bool>("start-change", "", "start of M6, with EMCIO = iov2 -support-start-change, until it is acknowledged", [](const PinOutputs &p) { return p.out.start_change; }),
    out<bool>("toolchanger-fault-ack", "", "acknowledges toolchanger-fault and its reason", [](const PinOutputs &p) { return p.out.toolchanger_fault_ack; }),
    out<bool>("toolchanger-faulted", "", "fault of the changer; with EMCIO = iov2 until it is cleared", [](const PinOutputs &p) { return p.out.toolchanger_faulted; }),
    out<Count>("tool-prep-number", "", "number of the requested tool", [](const PinOutputs &p) { return p.out.tool_prep_number; }),
    out<Count>("tool-prep-pocket", "", "pocket of the requested tool", [](const PinOutputs &p) { return p.out.tool_prep_pocket; }),
    out<Count>("tool-prep-index", "", "index of this tool in the tool table", [](const PinOutputs &p) { return p.out.tool_prep_index; }),
    out<Count>("tool-number", "", "number of the tool in the spindle; 0: none", [](const PinOutputs &p) { return p.out.tool_number; }),
    out<Count>("tool-from-pocket", "", "pocket of the tool in the spindle", [](const PinOutputs &p) { return p.out.tool_from_pocket; }),
    out<Count>("state", "", "0: no request to the changer; 1: a request is active", [](const PinOutputs &p) { return p.out.state; }));
// clang-format on

/// Calls `show(scope, row)` for every pin.
template <class Show>
void for_each(Show &&show) {
    sdk::for_each_pin(IOCONTROL, show);
}

}  // namespace pins
}  // namespace mw::io

// SPDX-License-Identifier: GPL-2.0-or-later
// The discrete I/O controller (requirement E1): e-stop chain, coolant, lube, tool prepare and change
// handshakes. Pure: inputs in, outputs out, time passed in. Pins: io/pins.hh.
#pragma once

#include <cstdint>
#include <string>

#include "base/result.hh"
#include "msgs/names.hh"

namespace mw::io {

struct Inputs {
    bool emc_enable_in = false;  ///< the e-stop chain is closed
    bool tool_prepared = false;
    bool tool_changed = false;
    bool lube_level = true;
    bool toolchanger_fault = false;
    int toolchanger_reason = 0;
};

struct Outputs {
    bool user_enable_out = false;
    bool user_request_enable = false;
    bool coolant_mist = false, coolant_flood = false, lube = false;
    bool tool_prepare = false, tool_change = false;
    bool emc_abort = false;
    int tool_prep_number = 0, tool_prep_pocket = 0, tool_prep_index = 0;
    int tool_number = 0, tool_from_pocket = 0;
    int state = 0;
};

enum class ToolAction : std::uint8_t { IDLE, PREPARING, CHANGING };

/// What a finished handshake means for the tool table.
enum class ToolEvent : std::uint8_t { NONE, PREPARED, CHANGED, FAULT };

class Controller {
  public:
    Outputs outputs{};

    /// One loop: sees the inputs, moves the handshakes on. Returns what has just been completed.
    ToolEvent step(const Inputs &inputs);

    /// Opens the chain from our side: user-enable-out false.
    void enter_estop();
    /// Closes our side: user-enable-out true and one pulse of user-request-enable.
    void leave_estop();
    bool isChainClosed() const { return isChainClosed_; }
    bool isEstopRequested() const { return !outputs.user_enable_out; }

    /// Starts tool-prepare for tool `number` in `pocket` (table index `index`).
    void start_prepare(int number, int pocket, int index);
    /// Starts tool-change to the prepared tool.
    void start_change();
    /// Ends any handshake at once: requests drop, emc-abort pulses for one loop.
    void abort();
    ToolAction action() const { return action_; }
    /// The pin that a handshake waits for.
    msgs::WaitFor waiting_for() const;
    int fault_reason() const { return fault_reason_; }

    void set_mist(bool isOn) { outputs.coolant_mist = isOn; }
    void set_flood(bool isOn) { outputs.coolant_flood = isOn; }
    void set_tool_in_spindle(int number, int from_pocket);

  private:
    ToolEvent step_handshake(const Inputs &inputs);

    ToolAction action_ = ToolAction::IDLE;
    bool isChainClosed_ = false;
    bool mustPulseRequest_ = false;
    bool mustPulseAbort_ = false;
    int fault_reason_ = 0;
};

}  // namespace mw::io

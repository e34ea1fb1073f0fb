// SPDX-License-Identifier: GPL-2.0-or-later
// The discrete I/O controller (requirement E1): e-stop chain, coolant, lubrication, handshakes for tool
// prepare and tool change. It has no side effects: it calculates outputs from inputs. Pins:
// machine/io/pins.hh.
#pragma once

#include <cstdint>
#include <string>

#include "base/geometry/pose.hh"
#include "base/result.hh"
#include "messages/declarations/names.hh"

namespace mw::io {

struct Inputs {
    bool emc_enable_in = false;  ///< the e-stop chain is closed
    bool tool_prepared = false;
    bool tool_changed = false;
    bool lube_level = true;
    bool toolchanger_fault = false;
    int toolchanger_reason = 0;
    bool toolchanger_clear_fault = false;
    bool emc_abort_ack = false;
    bool start_change_ack = false;
    bool tool_offset_shown = true;  ///< the pins show the tool offset of the last outputs
};

struct Outputs {
    bool user_enable_out = false;
    bool user_request_enable = false;
    bool coolant_mist = false, coolant_flood = false, lube = false;
    bool tool_prepare = false, tool_change = false;
    bool emc_abort = false, start_change = false;
    bool toolchanger_fault_ack = false, toolchanger_faulted = false;
    int emc_reason = 0;  ///< reason for aborting a request to the changer
    int tool_prep_number = 0, tool_prep_pocket = 0, tool_prep_index = 0;
    int tool_number = 0, tool_from_pocket = 0;
    int state = 0;
    geometry::Pose tool_offset;  ///< active tool offset [machine units]
};

/// Protocol of the changer ([EMCIO]EMCIO: io, or iov2 and its option).
struct Protocol {
    /// Aborts are acknowledged by emc-abort-ack, a fault remains until it is cleared, and after a fault with
    /// a reason above 0 the program continues.
    bool is_version2 = false;
    bool has_start_change = false;  ///< start-change is set and acknowledged before tool-change
};

enum class ToolAction : std::uint8_t { IDLE, PREPARING, STARTING, CHANGING, ABORTING };

/// Effect of a finished handshake on the tool table.
enum class ToolEvent : std::uint8_t {
    NONE,
    PREPARED,
    CHANGED,
    FAULT,         ///< fault; the program must not continue
    FAULT_TOLD,    ///< fault without a change; the program continues and can read #5600
    CHANGED_LATE,  ///< tool-changed arrived after the change was aborted
};

/// EMC_ABORT_BY_TOOLCHANGER_FAULT
inline constexpr int REASON_CHANGER_FAULT = 101;

class DiscreteIo {
  public:
    explicit DiscreteIo(const Protocol &protocol = {}) : protocol_(protocol) {}
    Outputs outputs{};

    /// Runs one cycle: reads the inputs and advances the handshakes. Returns the event of this cycle.
    ToolEvent step(const Inputs &inputs);

    /// Opens the e-stop chain on this side: user-enable-out false, lube off.
    void enter_estop();
    /// Closes this side of the chain: user-enable-out true and one pulse of user-request-enable; lubrication
    /// on when the chain is closed.
    void leave_estop();
    bool isChainClosed() const { return chain_closed_; }
    bool isEstopRequested() const { return !outputs.user_enable_out; }

    /// Starts tool-prepare for tool `number` in `pocket` (table index `index`).
    void start_prepare(int number, int pocket, int index);
    /// Starts tool-change to the prepared tool.
    void start_change();
    /// Called when the prepared tool has been loaded; no tool is prepared then.
    void clear_prepared();
    /// Ends any handshake at once: requests are reset. emc-abort is set for one cycle, in version 2 until it
    /// is acknowledged.
    void abort(int reason);
    ToolAction action() const { return action_; }
    /// The pin for which a handshake waits.
    messages::WaitFor waiting_for() const;
    int fault_reason() const { return fault_reason_; }

    void set_mist(bool on) { outputs.coolant_mist = on; }
    void set_flood(bool on) { outputs.coolant_flood = on; }
    void set_lube(bool on) { outputs.lube = on; }
    bool hasOil() const { return has_oil_; }
    void set_tool_in_spindle(int number, int from_pocket);
    /// Ignores values that are not finite: motion rejects the command with them.
    void set_tool_offset(const geometry::Pose &offset);
    bool isToolOffsetShown() const { return tool_offset_shown_; }

  private:
    void step_chain(const Inputs &inputs);
    void step_fault(const Inputs &inputs);
    void step_abort(const Inputs &inputs);
    ToolEvent step_handshake(const Inputs &inputs);
    ToolEvent end_by_fault();
    bool isLate(const Inputs &inputs);

    Protocol protocol_;
    ToolAction action_ = ToolAction::IDLE;
    bool chain_closed_ = false;
    bool request_pulse_due_ = false;
    bool abort_pulse_due_ = false;
    bool lube_due_ = false;  ///< lubrication is switched on when the chain is closed
    bool has_oil_ = true;
    bool abandoned_ = false;  ///< a change was aborted before its answer
    int fault_reason_ = 0;
    bool tool_offset_shown_ = true;
};

}  // namespace mw::io

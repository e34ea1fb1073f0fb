// SPDX-License-Identifier: GPL-2.0-or-later
// T, M6 and M61: from the number of a tool to its index in the table, to the changer, and back to the table.
#pragma once

#include <optional>
#include <string>
#include <utility>

#include "base/result.hh"
#include "gcode/canon/machine_canon.hh"
#include "machine/io/discrete_io.hh"
#include "machine/task/link/tool_store.hh"

namespace mw::task {

/// The prepared tool and the tool being loaded. The table follows the changer: it changes only in the cycle
/// in which the changer reports the tool as loaded. All calls come from one thread.
class ToolChange {
  public:
    /// `error_text` of [TASK]IO_ERROR: %d is the reason; empty: our own text.
    explicit ToolChange(std::string error_text = {}) : error_text_(std::move(error_text)) {}
    /// Requests the changer to prepare the tool; an error if the table does not have this number.
    Result<> select(const gcode::SelectTool &call, const ToolStore &tools, io::DiscreteIo &io);
    /// True if a tool was selected since the last change; otherwise M6 keeps the tool in the spindle.
    bool isSelected() const { return selected_.has_value(); }
    /// Starts the change, which is done when the changer is idle again. False if the tool is already in the
    /// spindle.
    bool start(const ToolStore &tools, io::DiscreteIo &io);
    /// Sets the tool in the spindle without a change.
    Result<> set_number(const gcode::ChangeToolNumber &call, ToolStore &tools, io::DiscreteIo &io);
    Result<> on_event(io::ToolEvent event, ToolStore &tools, io::DiscreteIo &io);
    /// Message for the operator about a fault of the changer.
    std::string fault_text(const io::DiscreteIo &io) const;
    /// Aborts the current change and its prepared tool; a tool prepared earlier is kept.
    void abort(const io::DiscreteIo &io);
    /// Index in the tool table; -1: none.
    int selected_index(const ToolStore &tools) const;
    /// Reason reported by the changer when its last request ended with a fault.
    std::optional<int> fault_reason() const { return fault_reason_; }

  private:
    /// Tools by number, because indices in the table change.
    std::optional<int> selected_, changing_;
    std::optional<int> fault_reason_;
    std::string error_text_;
};

/// Shows the table's tool in the spindle at the start.
void show_first_tool(const ToolStore &tools, io::DiscreteIo &io);

}  // namespace mw::task

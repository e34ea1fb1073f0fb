// SPDX-License-Identifier: GPL-2.0-or-later
// T, M6 and M61: from a tool's number to its place in the table, to the changer, and into the table again.
#pragma once

#include <optional>
#include <string>
#include <utility>

#include "base/result.hh"
#include "gcode/canon/machine_canon.hh"
#include "machine/io/discrete_io.hh"
#include "machine/task/link/tool_store.hh"

namespace mw::task {

/// Which tool is ready and which is on its way. The table follows the changer: it changes in the cycle in
/// which the changer says that the tool is in, and at no other time. One thread.
class ToolChange {
  public:
    /// `error_text` of [TASK]IO_ERROR: %d is the reason; empty: ours.
    explicit ToolChange(std::string error_text = {}) : error_text_(std::move(error_text)) {}
    /// The changer makes it ready; an error when the table has none of this number.
    Result<> select(const gcode::SelectTool &call, const ToolStore &tools, io::DiscreteIo &io);
    /// A tool was selected since the last change: without one M6 leaves the spindle's tool in place.
    bool isSelected() const { return selected_.has_value(); }
    /// The changer begins; over when it is idle again. False when that tool is in the spindle already: there
    /// is nothing to change.
    bool start(const ToolStore &tools, io::DiscreteIo &io);
    /// This tool is in the spindle, without a change.
    Result<> set_number(const gcode::ChangeToolNumber &call, ToolStore &tools, io::DiscreteIo &io);
    Result<> on_event(io::ToolEvent event, ToolStore &tools, io::DiscreteIo &io);
    /// What the operator is told of a fault of the changer.
    std::string fault_text(const io::DiscreteIo &io) const;
    /// What is on its way is given up, and what was made ready with it; a tool that was ready before stays
    /// so.
    void abort(const io::DiscreteIo &io);
    /// In the tool table; -1: none.
    int selected_index(const ToolStore &tools) const;
    /// As the changer has told it, when its last work ended with a fault.
    std::optional<int> fault_reason() const { return fault_reason_; }

  private:
    /// By its number: places in the table change.
    std::optional<int> selected_, changing_;
    std::optional<int> fault_reason_;
    std::string error_text_;
};

/// Shows the tool in the spindle at the start, as the table has it.
void show_first_tool(const ToolStore &tools, io::DiscreteIo &io);

}  // namespace mw::task

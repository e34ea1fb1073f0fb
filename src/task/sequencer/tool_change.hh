// SPDX-License-Identifier: GPL-2.0-or-later
// T, M6 and M61: from a tool's number to its place in the table, to the changer, and into the table again.
#pragma once

#include <optional>

#include "base/result.hh"
#include "interp/canon/machine_canon.hh"
#include "io/controller.hh"
#include "task/link/tool_store.hh"

namespace mw::task {

/// Which tool is ready and which is on its way. One thread.
class ToolChange {
  public:
    /// The changer makes it ready; an error when the table has none of this number.
    Result<> select(const interp::SelectTool &call, const ToolStore &tools, io::Controller &io);
    /// A tool was selected since the last change: without one M6 leaves the spindle's tool in place.
    bool isSelected() const { return selected_index_ >= 0; }
    /// The changer begins; over when it is idle again.
    void start(io::Controller &io);
    /// This tool is in the spindle, without a change.
    Result<> set_number(const interp::ChangeToolNumber &call, ToolStore &tools, io::Controller &io);
    Result<> on_event(io::ToolEvent event, ToolStore &tools, io::Controller &io);
    /// Nothing is selected, nothing on its way.
    void abort() { changing_index_ = selected_index_ = -1; }
    /// In the tool table; -1: none.
    int selected_index() const { return selected_index_; }
    /// As the changer has told it, when its last work ended with a fault.
    std::optional<int> fault_reason() const { return fault_reason_; }

  private:
    int selected_index_ = -1, changing_index_ = -1;
    std::optional<int> fault_reason_;
};

}  // namespace mw::task

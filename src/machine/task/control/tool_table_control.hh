// SPDX-License-Identifier: GPL-2.0-or-later
// The tool data for clients: reloads, edits, and the published table and tool.
#pragma once

#include "machine/task/control/run_parts.hh"

namespace mw::task {

/// All calls come from one thread.
class ToolTableControl {
  public:
    explicit ToolTableControl(const RunParts &parts) : parts_(parts) {}

    /// Ends when the table is read.
    Result<Progress> reload(mailbox::Serial command);
    /// Changes the data of a tool, adds a tool, or removes an unused tool. Only the changer moves tools.
    template <OneOf<SetToolEntry, AddTool, RemoveTool> Edit>
    Result<> edit(const Edit &command) {
        return parts_.calls.beside([&] { return apply(command); });
    }
    /// Called once in each cycle: publishes a table that was read or changed, and adds the wear of the tool
    /// since the status `last`.
    void step(const Status &last);
    void show(ToolStatus &status) const;

  private:
    Result<> apply(const SetToolEntry &order);
    Result<> apply(const AddTool &order);
    Result<> apply(const RemoveTool &order);
    void publish_table();

    const RunParts &parts_;
    std::uint64_t shown_version_ = 0;
    mailbox::Serial reload_ = 0;  ///< the LoadToolTable being executed; 0: none
    int prepared_index_ = -1;     ///< index of the tool that T has prepared; 0 (fixed changer) and -1: none
};

}  // namespace mw::task

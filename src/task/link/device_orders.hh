// SPDX-License-Identifier: GPL-2.0-or-later
// What an operator asks of coolant, lubrication and the tool data, outside programs.
#pragma once

#include "base/result.hh"
#include "io/controller.hh"
#include "msgs/device_commands.hh"
#include "task/link/tool_store.hh"

namespace mw::task {

Result<> switch_device(const msgs::MistOn &, io::Controller &io);
Result<> switch_device(const msgs::MistOff &, io::Controller &io);
Result<> switch_device(const msgs::FloodOn &, io::Controller &io);
Result<> switch_device(const msgs::FloodOff &, io::Controller &io);
/// Refused in emergency stop.
Result<> switch_device(const msgs::LubeOn &, io::Controller &io);
Result<> switch_device(const msgs::LubeOff &, io::Controller &io);

/// What of the tool data stays as it is for now.
struct ToolUse {
    int prepared_index = 0;  ///< of the tool that T has prepared; 0 (of a fixed changer) and -1: none
    bool isProgramHeld = false;
};
/// Data of a tool that is in the table, and of its copy in the spindle; the changer alone moves tools.
Result<> edit_tools(const msgs::SetToolEntry &order, const ToolUse &use, ToolStore &tools);
Result<> edit_tools(const msgs::AddTool &order, const ToolUse &use, ToolStore &tools);
/// Refused for tools in use: in the spindle, prepared, or any while a program is held that may call it.
Result<> edit_tools(const msgs::RemoveTool &order, const ToolUse &use, ToolStore &tools);

// What is added to the speed of a spindle that turns.
constexpr double speed_step_rpm(const msgs::SpindleIncrease &) {
    return 100;
}
constexpr double speed_step_rpm(const msgs::SpindleDecrease &) {
    return -100;
}

}  // namespace mw::task

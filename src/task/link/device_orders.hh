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

/// Data of a tool that is in the table, and of its copy in the spindle; the changer alone moves tools.
Result<> set_tool(const msgs::SetToolEntry &order, ToolStore &tools);
Result<> add_tool(const msgs::AddTool &order, ToolStore &tools);
/// `prepared`: index of the tool that T has prepared, which stays.
Result<> remove_tool(const msgs::RemoveTool &order, int prepared, ToolStore &tools);

// What is added to the speed of a spindle that turns.
constexpr double speed_step_rpm(const msgs::SpindleIncrease &) {
    return 100;
}
constexpr double speed_step_rpm(const msgs::SpindleDecrease &) {
    return -100;
}

}  // namespace mw::task

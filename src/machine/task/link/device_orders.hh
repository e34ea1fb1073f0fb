// SPDX-License-Identifier: GPL-2.0-or-later
// The operator's commands for coolant, lubrication and the tool data, outside programs.
#pragma once

#include "base/result.hh"
#include "machine/io/discrete_io.hh"
#include "machine/task/link/tool_store.hh"
#include "messages/declarations/device_commands.hh"

namespace mw::task {

Result<> switch_device(const messages::MistOn &, io::DiscreteIo &io);
Result<> switch_device(const messages::MistOff &, io::DiscreteIo &io);
Result<> switch_device(const messages::FloodOn &, io::DiscreteIo &io);
Result<> switch_device(const messages::FloodOff &, io::DiscreteIo &io);
/// Rejected in emergency stop.
Result<> switch_device(const messages::LubeOn &, io::DiscreteIo &io);
Result<> switch_device(const messages::LubeOff &, io::DiscreteIo &io);

/// Tool data that must not change now.
struct ToolUse {
    int prepared_index = 0;  ///< the tool that T has prepared; 0 (of a fixed changer) and -1: none
    bool program_paused = false;
};
/// Changes the data of a tool in the table, and of its copy in the spindle; only the changer moves tools.
Result<> edit_tools(const messages::SetToolEntry &order, const ToolUse &use, ToolStore &tools);
Result<> edit_tools(const messages::AddTool &order, const ToolUse &use, ToolStore &tools);
/// Rejected for tools in use: in the spindle, prepared, or any tool while a paused program may call it.
Result<> edit_tools(const messages::RemoveTool &order, const ToolUse &use, ToolStore &tools);

// Change of speed for a running spindle.
constexpr double speed_step_rpm(const messages::SpindleIncrease &) {
    return 100;
}
constexpr double speed_step_rpm(const messages::SpindleDecrease &) {
    return -100;
}

}  // namespace mw::task

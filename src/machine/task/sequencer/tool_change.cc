// SPDX-License-Identifier: GPL-2.0-or-later
#include "machine/task/sequencer/tool_change.hh"

#include <algorithm>
#include <string>
#include <string_view>
#include <utility>

namespace mw::task {
namespace {

/// Index of a tool; 0 for "no tool" of a fixed changer, -1 if the table does not have the tool.
int index_of(int toolno, const ToolStore &tools) {
    return toolno == 0 && !tools.isRandom() ? 0 : tools.index_of_tool(toolno);
}

/// Entry of the table, or "no tool" for index 0 of a fixed changer.
gcode::ToolEntry tool_at(const ToolStore &tools, int index) {
    gcode::ToolEntry none;
    none.toolno = 0;
    return index > 0 || tools.isRandom() ? tools.entry(index) : none;
}

Result<> not_there(int toolno) {
    return fail("tool " + std::to_string(toolno) + " is not in the tool table");
}

}  // namespace

Result<> ToolChange::select(const gcode::SelectTool &call, const ToolStore &tools, io::DiscreteIo &io) {
    const int index = index_of(call.toolno, tools);
    if (index < 0) {
        return not_there(call.toolno);
    }
    selected_ = call.toolno;
    io.start_prepare(call.toolno, tool_at(tools, index).pocketno, index);
    return {};
}

bool ToolChange::start(const ToolStore &tools, io::DiscreteIo &io) {
    // Also unloads an empty spindle, because its state is unknown after a start.
    const bool is_tool = *selected_ > 0 || tools.isRandom();
    const bool present = is_tool && tools.entry(0).toolno == *selected_;
    if (present) {
        return false;
    }
    changing_ = selected_;
    io.start_change();
    return true;
}

Result<> ToolChange::set_number(const gcode::ChangeToolNumber &call, ToolStore &tools, io::DiscreteIo &io) {
    const int index = index_of(call.toolno, tools);
    if (index < 0) {
        return not_there(call.toolno);
    }
    // No changer took the tool out of a pocket, so the pocket number of the last tool is kept, as in
    // LinuxCNC.
    Result<> loaded = tools.load_spindle(index);
    io.set_tool_in_spindle(call.toolno, call.toolno == 0 ? 0 : io.outputs.tool_from_pocket);
    return loaded;
}

Result<> ToolChange::on_event(io::ToolEvent event, ToolStore &tools, io::DiscreteIo &io) {
    if (event == io::ToolEvent::NONE) {
        return {};
    }
    fault_reason_.reset();
    if (event == io::ToolEvent::FAULT || event == io::ToolEvent::FAULT_TOLD) {
        fault_reason_ = io.fault_reason();
        selected_.reset();
        changing_.reset();
        io.clear_prepared();
        return event == io::ToolEvent::FAULT_TOLD ? Result<>{} : fail(fault_text(io));
    }
    if (event != io::ToolEvent::CHANGED || !changing_.has_value()) {
        return {};
    }
    const int toolno = *std::exchange(changing_, std::nullopt);
    selected_.reset();
    const int index = index_of(toolno, tools);
    const bool is_tool = index >= 0 && toolno > 0;  // T0 is an empty spindle, also with a random changer
    const int pocket = is_tool ? tool_at(tools, index).pocketno : 0;
    Result<> loaded = index < 0 ? not_there(toolno) : tools.load_spindle(index);
    io.set_tool_in_spindle(toolno, pocket);
    io.clear_prepared();
    return loaded;
}

std::string ToolChange::fault_text(const io::DiscreteIo &io) const {
    constexpr std::string_view MARK = "%d";
    const std::string reason = std::to_string(io.fault_reason());
    std::string text = error_text_;
    const std::size_t at = text.find(MARK);
    if (!text.empty() && io.fault_reason() < 0) {
        return at == std::string::npos ? text : text.replace(at, MARK.size(), reason);
    }
    return "the tool changer reports a fault (iocontrol.0.toolchanger-reason " + reason + ")";
}

void ToolChange::abort(const io::DiscreteIo &io) {
    if (io.action() != io::ToolAction::IDLE) {
        selected_.reset();
    }
    changing_.reset();
}

int ToolChange::selected_index(const ToolStore &tools) const {
    return selected_.has_value() ? index_of(*selected_, tools) : -1;
}

void show_first_tool(const ToolStore &tools, io::DiscreteIo &io) {
    io.set_tool_in_spindle(tools.isRandom() ? tools.entry(0).toolno : 0, 0);
}

}  // namespace mw::task

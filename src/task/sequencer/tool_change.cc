// SPDX-License-Identifier: GPL-2.0-or-later
#include "task/sequencer/tool_change.hh"

#include <string>

namespace mw::task {
namespace {

/// Entry of the table, or "no tool" for index 0.
interp::ToolEntry tool_at(const ToolStore &tools, int index) {
    interp::ToolEntry none;
    none.toolno = 0;
    return index > 0 ? tools.entry(index) : none;
}

}  // namespace

Result<> ToolChange::select(const interp::SelectTool &call, const ToolStore &tools, io::Controller &io) {
    const int index = call.toolno == 0 ? 0 : tools.index_of_tool(call.toolno);
    if (index < 0) {
        return fail("tool " + std::to_string(call.toolno) + " is not in the tool table");
    }
    selected_index_ = index;
    io.start_prepare(call.toolno, tool_at(tools, index).pocketno, index);
    return {};
}

void ToolChange::start(io::Controller &io) {
    changing_index_ = selected_index_;
    io.start_change();
}

Result<> ToolChange::set_number(const interp::ChangeToolNumber &call, ToolStore &tools, io::Controller &io) {
    const int index = call.toolno == 0 ? 0 : tools.index_of_tool(call.toolno);
    Result<> loaded = tools.load_spindle(index);
    io.set_tool_in_spindle(call.toolno, tool_at(tools, index).pocketno);
    return loaded;
}

Result<> ToolChange::on_event(io::ToolEvent event, ToolStore &tools, io::Controller &io) {
    if (event == io::ToolEvent::NONE) {
        return {};
    }
    fault_reason_.reset();
    if (event == io::ToolEvent::FAULT) {
        fault_reason_ = io.fault_reason();
        return fail("the tool changer reports a fault (iocontrol.0.toolchanger-reason " +
                    std::to_string(io.fault_reason()) + ")");
    }
    if (event != io::ToolEvent::CHANGED || changing_index_ < 0) {
        return {};
    }
    const interp::ToolEntry entry = tool_at(tools, changing_index_);
    Result<> loaded = tools.load_spindle(changing_index_);
    io.set_tool_in_spindle(entry.toolno, entry.pocketno);
    abort();
    return loaded;
}

}  // namespace mw::task

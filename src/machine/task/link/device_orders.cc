// SPDX-License-Identifier: GPL-2.0-or-later
#include "machine/task/link/device_orders.hh"

#include <algorithm>

#include <fmt/format.h>

namespace mw::task {

Result<> switch_device(const messages::MistOn &, io::DiscreteIo &io) {
    io.set_mist(true);
    return {};
}

Result<> switch_device(const messages::MistOff &, io::DiscreteIo &io) {
    io.set_mist(false);
    return {};
}

Result<> switch_device(const messages::FloodOn &, io::DiscreteIo &io) {
    io.set_flood(true);
    return {};
}

Result<> switch_device(const messages::FloodOff &, io::DiscreteIo &io) {
    io.set_flood(false);
    return {};
}

Result<> switch_device(const messages::LubeOn &, io::DiscreteIo &io) {
    if (io.isEstopRequested()) {
        return fail("there is no lubrication in emergency stop");
    }
    io.set_lube(true);
    return {};
}

Result<> switch_device(const messages::LubeOff &, io::DiscreteIo &io) {
    io.set_lube(false);
    return {};
}

Result<> edit_tools(const messages::SetToolEntry &order, const ToolUse &, ToolStore &tools) {
    const int index = tools.index_of_tool(order.toolno);
    if (index < 0) {
        return fail(fmt::format("tool {} is not in the tool table", order.toolno));
    }
    gcode::ToolEntry entry = tools.entry(index);
    if (order.pocket != 0 && order.pocket != entry.pocketno) {
        return fail(
            fmt::format("tool {} is in pocket {}: only the changer moves it", order.toolno, entry.pocketno));
    }
    entry.offset = order.offset;
    entry.diameter = order.diameter;
    entry.frontangle = order.frontangle_deg;
    entry.backangle = order.backangle_deg;
    entry.orientation = order.orientation;
    const Result<> set = tools.set_entry(index, entry);
    const bool has_copy = !tools.isRandom() && tools.entry(0).toolno == order.toolno;
    const Result<> copied = set.has_value() && has_copy ? tools.set_entry(0, entry) : set;
    return copied.has_value() ? tools.save() : copied;
}

Result<> edit_tools(const messages::AddTool &order, const ToolUse &, ToolStore &tools) {
    const auto is_control = [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; };
    if (std::ranges::any_of(order.comment, is_control)) {
        return fail("the comment of a tool is one line of text");
    }
    gcode::ToolEntry entry;
    entry.toolno = order.toolno;
    entry.pocketno = order.pocket;
    entry.offset = order.offset;
    entry.diameter = order.diameter;
    entry.frontangle = order.frontangle_deg;
    entry.backangle = order.backangle_deg;
    entry.orientation = order.orientation;
    entry.comment = order.comment;
    return tools.add(entry);
}

Result<> edit_tools(const messages::RemoveTool &order, const ToolUse &use, ToolStore &tools) {
    const int index = tools.index_of_tool(order.toolno);
    if (index < 0) {
        return fail(fmt::format("tool {} is not in the tool table", order.toolno));
    }
    if (use.program_paused) {
        return fail(
            fmt::format("a paused program may call tool {}: it is removed after the program", order.toolno));
    }
    if (index == use.prepared_index && tools.entry(0).toolno != order.toolno) {
        return fail(fmt::format(
            "tool {} is prepared for the next change: it is removed when another tool is prepared",
            order.toolno));
    }
    return tools.remove(index);
}

}  // namespace mw::task

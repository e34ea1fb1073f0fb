// SPDX-License-Identifier: GPL-2.0-or-later
#include "machine/task/control/tool_table_control.hh"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

namespace mw::task {
namespace {

/// Cutting time and length of the tool in the spindle since that status: time with axes at feed while a
/// spindle runs.
tools::CutLife cut_since(const Status &status, std::int64_t now_ns) {
    constexpr double S_PER_NS = 1e-9;
    const double elapsed_s = static_cast<double>(now_ns - status.time_ns) * S_PER_NS;
    const MoveKind kind = status.trajectory.move_kind;
    const bool feeding = kind == MoveKind::FEED || kind == MoveKind::ARC;
    const bool turning =
        std::ranges::any_of(status.spindles, [](const SpindleStatus &spindle) { return spindle.isOn; });
    const double velocity = std::abs(status.trajectory.current_velocity);
    const bool cutting = feeding && turning && velocity > 0 && status.tool.in_spindle > 0;
    return cutting ? tools::CutLife{elapsed_s, velocity * elapsed_s} : tools::CutLife{};
}

}  // namespace

Result<Progress> ToolTableControl::reload(mailbox::Serial command) {
    if (reload_ != 0) {
        return fail("the tool table is being read already");
    }
    const auto begun = parts_.tools.reload();
    if (!begun.has_value()) {
        return std::unexpected(begun.error());
    }
    reload_ = command;
    return Progress::STARTED;
}

void ToolTableControl::step(const Status &last) {
    parts_.tools.step();
    while (const auto warning = parts_.tools.take_warning()) {
        parts_.port.post_error(*warning);
    }
    const auto read = reload_ != 0 ? parts_.tools.reload_result() : std::nullopt;
    if (read.has_value()) {
        const std::string reason = read->has_value() ? std::string() : read->error().str();
        parts_.port.tell(
            Ending{std::exchange(reload_, 0), reason.empty() ? Progress::DONE : Progress::FAILED, reason});
        if (!reason.empty()) {
            parts_.port.post_error(reason);
        }
    }
    parts_.tools.note_cut(last.tool.in_spindle, cut_since(last, parts_.port.now_ns()));
    publish_table();
    // A tool that is being prepared is not ready yet; no tool (T0) is ready at once.
    const int selected = parts_.sequencer.selected_tool_index();
    const bool none = selected == 0 && !parts_.tools.isRandom();
    if (none || parts_.io.action() != io::ToolAction::PREPARING) {
        prepared_index_ = selected;
    }
}

Result<> ToolTableControl::apply(const SetToolEntry &order) {
    ToolStore &tools = parts_.tools;
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

Result<> ToolTableControl::apply(const AddTool &order) {
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
    return parts_.tools.add(entry);
}

Result<> ToolTableControl::apply(const RemoveTool &order) {
    ToolStore &tools = parts_.tools;
    const int index = tools.index_of_tool(order.toolno);
    if (index < 0) {
        return fail(fmt::format("tool {} is not in the tool table", order.toolno));
    }
    if (parts_.run.hold() == Hold::AWAY) {
        return fail(
            fmt::format("a paused program may call tool {}: it is removed after the program", order.toolno));
    }
    if (index == prepared_index_ && tools.entry(0).toolno != order.toolno) {
        return fail(fmt::format(
            "tool {} is prepared for the next change: it is removed when another tool is prepared",
            order.toolno));
    }
    return tools.remove(index);
}

/// Publishes the table if it has changed since the last call.
void ToolTableControl::publish_table() {
    const std::uint64_t version = parts_.tools.version();
    if (version == shown_version_) {
        return;
    }
    shown_version_ = version;
    messages::ToolTable table{version, {}};
    for (int i = 0; i < parts_.tools.count(); ++i) {
        const gcode::ToolEntry entry = parts_.tools.entry(i);
        table.tools.push_back({entry.toolno, entry.pocketno, entry.offset, entry.diameter, entry.frontangle,
                               entry.backangle, entry.orientation, entry.comment});
    }
    if (!parts_.port.server().publish_tools(table)) {
        parts_.port.post_error("the tool table is too large to be shown to clients");
    }
}

void ToolTableControl::show(ToolStatus &status) const {
    const int tool = parts_.io.outputs.tool_number;
    status.in_spindle = tool;
    status.from_pocket = parts_.io.outputs.tool_from_pocket;
    status.prepared_index = prepared_index_;
    status.table_version = shown_version_;
    const tools::CutLife life = parts_.tools.life(tool);
    status.cut_time_s = life.time_s;
    status.cut_length = life.length;
}

}  // namespace mw::task

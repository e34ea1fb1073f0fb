// SPDX-License-Identifier: GPL-2.0-or-later
#include "machine/task/run/start_record.hh"

#include <algorithm>

#include <fmt/format.h>

#include "base/bytes.hh"
#include "base/limits.hh"
#include "base/overloaded.hh"
#include "machine/journal/records.hh"

namespace mw::task {
namespace {

/// Version of the format; other versions are not read.
constexpr std::uint32_t FORM = 2;

template <class Io, class Pose>
void pose(Io &io, Pose &values) {
    for (int axis = 0; axis < geometry::AXIS_COUNT; ++axis) {
        io(values[axis]);
    }
}

template <class Io, class Snapshot>
void snapshot(Io &io, Snapshot &s) {
    pose(io, s.position);
    pose(io, s.probed_position);
    io(s.isProbeTripped);
    io(s.input_value);
    io(s.isInputTimedOut);
    io(s.isMistOn);
    io(s.isFloodOn);
    io(s.isFeedOverrideEnabled);
    io(s.speed_override_enabled);
    io(s.isFeedHoldEnabled);
    io(s.isAdaptiveFeedEnabled);
    io(s.feed_rate);
    for (std::size_t i = 0; i < s.spindle_speed.size(); ++i) {
        io(s.spindle_speed[i]);
        io(s.spindle_direction[i]);
    }
    io(s.tool_in_spindle);
    io(s.tool_faulted);
    io(s.tool_fault_reason);
    io(s.selected_pocket);
    io(s.current_pocket);
}

template <class Io, class Tool>
void tool(Io &io, Tool &entry) {
    io(entry.toolno);
    io(entry.pocketno);
    pose(io, entry.offset);
    io(entry.diameter);
    io(entry.frontangle);
    io(entry.backangle);
    io(entry.orientation);
    io(entry.comment);
}

/// Reads a list. Each element has at least one byte, so a count above the number of remaining bytes is not
/// valid.
template <class One, class Fields>
void list(Packer &out, const std::vector<One> &all, const Fields &fields) {
    out(static_cast<std::uint64_t>(all.size()));
    for (const One &one : all) {
        fields(one);
    }
}
template <class One, class Fields>
void list(Unpacker &in, std::vector<One> &all, const Fields &fields) {
    std::uint64_t count = 0;
    in(count);
    if (count > in.left()) {
        in.spoil();
        return;
    }
    for (std::uint64_t i = 0; i < count && in.isGood(); ++i) {
        One one{};
        fields(one);
        all.push_back(std::move(one));
    }
}

template <class Io, class Record>
void fields(Io &io, Record &record) {
    io(record.interpreter);
    io(record.frame);
    snapshot(io, record.machine);
    io(record.isBlockDelete);
    io(record.isOptionalStop);
    io(record.confined);
    list(io, record.tools, [&](auto &one) { tool(io, one); });
    io(record.offsets.g5x_index);
    pose(io, record.offsets.g5x);
    pose(io, record.offsets.g92);
    io(record.offsets.rotation_xy_deg);
    pose(io, record.tool_offset.offset);
    list(io, record.spindle_modes, [&](auto &one) {
        io(one.spindle);
        io(one.css_max_rpm);
    });
    list(io, record.spindle_speeds, [&](auto &one) {
        io(one.spindle);
        io(one.speed);
        io(one.surface_unit);
    });
    list(io, record.spindle_starts, [&](auto &one) {
        io(one.spindle);
        io(one.clockwise);
        io(one.waiting);
    });
    io(record.digital_out);
    list(io, record.analog_out, [&](auto &value) { io(value); });
}

bool isSpindle(int number) {
    return number >= 0 && number < MAX_SPINDLES;
}

/// Checks numbers that are used as indices of tables.
bool canBe(const StartRecord &record) {
    const int tools = static_cast<int>(record.tools.size());
    return tools > 0 && record.machine.selected_pocket >= -1 && record.machine.selected_pocket < tools &&
           record.machine.current_pocket >= 0 && record.machine.current_pocket < tools &&
           std::ranges::all_of(
               record.spindle_modes, [](const auto &one) { return isSpindle(one.spindle); }) &&
           std::ranges::all_of(
               record.spindle_speeds, [](const auto &one) { return isSpindle(one.spindle); }) &&
           std::ranges::all_of(
               record.spindle_starts, [](const auto &one) { return isSpindle(one.spindle); }) &&
           record.analog_out.size() <= MAX_ANALOG_IO;
}

}  // namespace

std::string StartRecord::pack() const {
    Packer out;
    out(FORM);
    fields(out, *this);
    return out.bytes();
}

std::optional<StartRecord> StartRecord::unpack(std::string_view bytes) {
    Unpacker in(bytes);
    std::uint32_t form = 0;
    StartRecord record;
    in(form);
    if (form != FORM) {
        return std::nullopt;
    }
    fields(in, record);
    return in.isComplete() && canBe(record) ? std::optional(std::move(record)) : std::nullopt;
}

void StartRecord::add_spindles(const std::vector<gcode::MachineCall> &starts) {
    for (const gcode::MachineCall &call : starts) {
        if (const auto *mode = std::get_if<gcode::SetSpindleMode>(&call)) {
            spindle_modes.push_back(*mode);
        } else if (const auto *speed = std::get_if<gcode::UseSpindleSpeed>(&call)) {
            spindle_speeds.push_back(*speed);
        } else if (const auto *start = std::get_if<gcode::StartSpindle>(&call)) {
            spindle_starts.push_back(*start);
        }
    }
}

std::vector<gcode::MachineCall> StartRecord::calls() const {
    std::vector<gcode::MachineCall> all;
    all.emplace_back(offsets);
    all.emplace_back(tool_offset);
    all.emplace_back(gcode::SwitchFeedOverride{machine.isFeedOverrideEnabled});
    all.emplace_back(gcode::SwitchFeedHold{machine.isFeedHoldEnabled});
    all.emplace_back(gcode::SwitchAdaptiveFeed{machine.isAdaptiveFeedEnabled});
    all.emplace_back(gcode::SwitchSpeedOverride{0, machine.speed_override_enabled});
    all.insert(all.end(), spindle_modes.begin(), spindle_modes.end());
    all.insert(all.end(), spindle_speeds.begin(), spindle_speeds.end());
    all.insert(all.end(), spindle_starts.begin(), spindle_starts.end());
    for (int i = 0; i < MAX_DIGITAL_IO; ++i) {
        if ((digital_out >> i & 1U) != 0) {
            all.emplace_back(gcode::SetDigitalOutput{i, true, false});
        }
    }
    for (std::size_t i = 0; i < analog_out.size(); ++i) {
        if (analog_out[i] != 0) {
            all.emplace_back(gcode::SetAnalogOutput{static_cast<int>(i), analog_out[i], false});
        }
    }
    return all;
}

int RecordedWorld::index_of_tool(int toolno) const {
    const int first = isRandom() ? 0 : 1;
    for (int i = first; i < count(); ++i) {
        if (record_.tools[static_cast<std::size_t>(i)].toolno == toolno) {
            return i;
        }
    }
    return -1;
}

namespace {

bool isSame(const gcode::ToolEntry &a, const gcode::ToolEntry &b) {
    Packer packed_a, packed_b;
    tool(packed_a, a);
    tool(packed_b, b);
    return packed_a.bytes() == packed_b.bytes();
}

/// Tool data that the program has set; null: none.
const gcode::ToolEntry *set_by_program(const FoundModes &found, int index) {
    const gcode::ToolEntry *last = nullptr;
    for (const gcode::MachineCall &call : found.settings) {
        const auto *one = std::get_if<gcode::SetToolTableEntry>(&call);
        last = one != nullptr && one->index == index ? &one->entry : last;
    }
    return last;
}

}  // namespace

Result<StartRecord> with_tools_now(StartRecord record, const FoundModes &found,
                                   const gcode::ToolSource &tools) {
    if (tools.count() != static_cast<int>(record.tools.size())) {
        return fail("the tool table has other tools");
    }
    for (int i = tools.isRandom() ? 0 : 1; i < tools.count(); ++i) {
        const gcode::ToolEntry now = tools.entry(i);
        gcode::ToolEntry &then = record.tools[static_cast<std::size_t>(i)];
        if (now.toolno != then.toolno) {
            return fail("the tool table has other tools");
        }
        const gcode::ToolEntry *const set = set_by_program(found, i);
        if (isSame(now, set != nullptr ? *set : then)) {
            continue;
        }
        if (set != nullptr) {
            return fail(
                fmt::format("the program itself sets the data of tool {}, which were changed", now.toolno));
        }
        gcode::ToolEntry &spindle = record.tools[0];
        if (i > 0 && spindle.toolno == now.toolno) {  // the copy in the spindle of a fixed changer
            const int pocket = spindle.pocketno;
            spindle = now;
            spindle.pocketno = pocket;
        }
        then = now;
    }
    return record;
}

std::uint64_t sum_of_tools(const gcode::ToolSource &tools) {
    Packer out;
    for (int i = tools.isRandom() ? 0 : 1; i < tools.count(); ++i) {
        const gcode::ToolEntry entry = tools.entry(i);
        tool(out, entry);
    }
    return journal::mark_of(out.bytes()).sum;
}

}  // namespace mw::task

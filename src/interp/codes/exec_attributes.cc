// SPDX-License-Identifier: GPL-2.0-or-later
// The state by the names that scripts use: one row each. Lengths in program units, angles in degrees.
#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <span>

#include <fmt/format.h>

#include "interp/codes/executor.hh"

namespace mw::interp::detail {
namespace {

using Reader = ScriptValue (*)(const Executor &executor);
using Writer = void (*)(Executor &executor, double value);

struct Row {
    std::string_view name;
    Reader read;
    Writer write = nullptr;  ///< null: read only
};

std::int64_t whole(int value) {
    return value;
}

/// Units and planes as scripts number them.
int unit_number(LengthUnits units) {
    return units == LengthUnits::INCH ? 1 : 2;
}

int side_number(CompSide side) {
    return side == CompSide::OFF ? 0 : (side == CompSide::RIGHT ? 1 : 2);
}

int to_whole(double value) {
    constexpr double MOST = 2147483647.0;
    return static_cast<int>(std::lround(std::clamp(value, -MOST, MOST)));
}

SpindleState &spindle(Executor &e) {
    return e.state.spindles[static_cast<std::size_t>(e.state.active_spindle)];
}
const SpindleState &spindle(const Executor &e) {
    return e.state.spindles[static_cast<std::size_t>(e.state.active_spindle)];
}

constexpr Row MODES[] = {
    {"active_spindle", [](const Executor &e) -> ScriptValue { return whole(e.state.active_spindle); },
     [](Executor &e, double v) {
         e.state.active_spindle = std::clamp(to_whole(v), 0, e.world().count_spindles() - 1);
     }},
    {"arc_not_allowed", [](const Executor &e) -> ScriptValue { return e.state.isCompExit; },
     [](Executor &e, double v) { e.state.isCompExit = v != 0; }},
    {"cutter_comp_firstmove", [](const Executor &e) -> ScriptValue { return !e.state.comp_last.isSet; }},
    {"cutter_comp_orientation",
     [](const Executor &e) -> ScriptValue { return whole(e.state.comp_orientation); }},
    {"cutter_comp_radius", [](const Executor &e) -> ScriptValue { return e.state.comp_radius; }},
    {"cutter_comp_side", [](const Executor &e) -> ScriptValue { return whole(side_number(e.state.comp)); }},
    {"distance_mode", [](const Executor &e) -> ScriptValue { return whole(e.state.isIncremental ? 1 : 0); },
     [](Executor &e, double v) { e.state.isIncremental = v != 0; }},
    {"feed_mode", [](const Executor &e) -> ScriptValue { return whole(static_cast<int>(e.state.feed_mode)); },
     [](Executor &e, double v) { e.state.feed_mode = static_cast<FeedMode>(std::clamp(to_whole(v), 0, 2)); }},
    {"feed_override", [](const Executor &e) -> ScriptValue { return e.state.isFeedOverride; },
     [](Executor &e, double v) { e.state.isFeedOverride = v != 0; }},
    {"feed_rate", [](const Executor &e) -> ScriptValue { return e.state.feed; },
     [](Executor &e, double v) { e.state.feed = v; }},
    {"flood", [](const Executor &e) -> ScriptValue { return e.state.isFlood; },
     [](Executor &e, double v) { e.state.isFlood = v != 0; }},
    {"ijk_distance_mode",
     [](const Executor &e) -> ScriptValue { return whole(e.state.isCentreAbsolute ? 0 : 1); },
     [](Executor &e, double v) { e.state.isCentreAbsolute = v == 0; }},
    {"length_units", [](const Executor &e) -> ScriptValue { return whole(unit_number(e.state.units)); }},
    {"mist", [](const Executor &e) -> ScriptValue { return e.state.isMist; },
     [](Executor &e, double v) { e.state.isMist = v != 0; }},
    {"motion_mode", [](const Executor &e) -> ScriptValue { return whole(e.state.motion); },
     [](Executor &e, double v) { e.state.motion = to_whole(v); }},
    {"origin_index", [](const Executor &e) -> ScriptValue { return whole(e.state.g5x_index); }},
    {"plane", [](const Executor &e) -> ScriptValue { return whole(e.plane_number()); }},
    {"retract_mode", [](const Executor &e) -> ScriptValue { return whole(e.state.isRetractToR ? 0 : 1); },
     [](Executor &e, double v) { e.state.isRetractToR = v == 0; }},
    {"rotation_xy", [](const Executor &e) -> ScriptValue { return e.state.rotation_deg; }},
    {"speed_feed_mode", [](const Executor &) -> ScriptValue { return whole(2); }},
    {"speed_override", [](const Executor &e) -> ScriptValue { return spindle(e).isOverridden; },
     [](Executor &e, double v) { spindle(e).isOverridden = v != 0; }},
    {"spindle_mode",
     [](const Executor &e) -> ScriptValue { return whole(spindle(e).isConstantSurface ? 1 : 0); }},
    {"spindle_turning",
     [](const Executor &e) -> ScriptValue {
         constexpr std::array<int, 3> NUMBERS{3, 1, 2};  // counterclockwise, stopped, clockwise
         return whole(NUMBERS[static_cast<std::size_t>(spindle(e).direction + 1)]);
     }},
    {"traverse_rate", [](const Executor &) -> ScriptValue { return 0.0; }},
};

constexpr Row CYCLES[] = {
    {"cycle_cc", [](const Executor &e) -> ScriptValue { return e.state.cycle.bottom; },
     [](Executor &e, double v) { e.state.cycle.bottom = v; }},
    {"cycle_i", [](const Executor &e) -> ScriptValue { return e.state.cycle.i; },
     [](Executor &e, double v) { e.state.cycle.i = v; }},
    {"cycle_il", [](const Executor &e) -> ScriptValue { return e.state.cycle.initial; },
     [](Executor &e, double v) { e.state.cycle.initial = v; }},
    {"cycle_il_flag", [](const Executor &e) -> ScriptValue { return whole(e.state.cycle.isRunning ? 1 : 0); },
     [](Executor &e, double v) { e.state.cycle.isRunning = v != 0; }},
    {"cycle_j", [](const Executor &e) -> ScriptValue { return e.state.cycle.j; },
     [](Executor &e, double v) { e.state.cycle.j = v; }},
    {"cycle_k", [](const Executor &e) -> ScriptValue { return e.state.cycle.k; },
     [](Executor &e, double v) { e.state.cycle.k = v; }},
    {"cycle_l", [](const Executor &) -> ScriptValue { return whole(0); }},
    {"cycle_p", [](const Executor &e) -> ScriptValue { return e.state.cycle.p; },
     [](Executor &e, double v) { e.state.cycle.p = v; }},
    {"cycle_q", [](const Executor &e) -> ScriptValue { return e.state.cycle.q; },
     [](Executor &e, double v) { e.state.cycle.q = v; }},
    {"cycle_r", [](const Executor &e) -> ScriptValue { return e.state.cycle.r; },
     [](Executor &e, double v) { e.state.cycle.r = v; }},
};

constexpr Row TOOLS[] = {
    {"current_pocket", [](const Executor &e) -> ScriptValue { return whole(e.state.tool_index); },
     [](Executor &e, double v) { e.state.tool_index = to_whole(v); }},
    {"current_tool", [](const Executor &e) -> ScriptValue { return whole(e.state.tool_in_spindle); },
     [](Executor &e, double v) { e.state.tool_in_spindle = to_whole(v); }},
    {"random_toolchanger",
     [](const Executor &e) -> ScriptValue { return whole(e.tools().isRandom() ? 1 : 0); }},
    {"selected_pocket", [](const Executor &e) -> ScriptValue { return whole(e.state.selected_index); },
     [](Executor &e, double v) { e.state.selected_index = to_whole(v); }},
    {"selected_tool", [](const Executor &e) -> ScriptValue { return whole(e.state.selected_tool); },
     [](Executor &e, double v) { e.state.selected_tool = to_whole(v); }},
    {"tool_change_at_g30", [](const Executor &) -> ScriptValue { return whole(0); }},
    {"tool_change_quill_up", [](const Executor &) -> ScriptValue { return whole(0); }},
    {"tool_change_with_spindle_on", [](const Executor &) -> ScriptValue { return whole(0); }},
    {"toolchange_flag", [](const Executor &e) -> ScriptValue { return e.isToolChanged; },
     [](Executor &e, double v) { e.isToolChanged = v != 0; }},
};

constexpr Row REST[] = {
    {"a_axis_wrapped", [](const Executor &) -> ScriptValue { return whole(0); }},
    {"a_indexer_jnum", [](const Executor &) -> ScriptValue { return whole(-1); }},
    {"b_axis_wrapped", [](const Executor &) -> ScriptValue { return whole(0); }},
    {"b_indexer_jnum", [](const Executor &) -> ScriptValue { return whole(-1); }},
    {"c_axis_wrapped", [](const Executor &) -> ScriptValue { return whole(0); }},
    {"c_indexer_jnum", [](const Executor &) -> ScriptValue { return whole(-1); }},
    {"debugmask", [](const Executor &e) -> ScriptValue { return whole(e.debug_mask); },
     [](Executor &e, double v) { e.debug_mask = to_whole(v); }},
    {"input_digital", [](const Executor &) -> ScriptValue { return false; }},
    {"input_flag", [](const Executor &e) -> ScriptValue { return e.isInputExpected(); },
     [](Executor &e, double v) { e.expect_input(v != 0); }},
    {"input_index", [](const Executor &) -> ScriptValue { return whole(-1); }},
    {"loggingLevel", [](const Executor &e) -> ScriptValue { return whole(e.logging_level); },
     [](Executor &e, double v) { e.logging_level = to_whole(v); }},
    {"mdi_interrupt", [](const Executor &) -> ScriptValue { return false; }},
    {"num_spindles", [](const Executor &e) -> ScriptValue { return whole(e.world().count_spindles()); }},
    {"probe_flag", [](const Executor &e) -> ScriptValue { return e.isProbeExpected(); },
     [](Executor &e, double v) { e.expect_probe(v != 0); }},
    {"remap_level", [](const Executor &e) -> ScriptValue { return whole(e.remap_level()); }},
    {"return_value", [](const Executor &e) -> ScriptValue { return e.returned_value(); },
     [](Executor &e, double v) { e.set_returned(v, e.isValueReturned()); }},
    {"sequence_number", [](const Executor &e) -> ScriptValue { return whole(e.line()); }},
    {"task", [](const Executor &e) -> ScriptValue { return whole(e.settings().isTask ? 1 : 0); }},
    {"value_returned", [](const Executor &e) -> ScriptValue { return whole(e.isValueReturned() ? 1 : 0); },
     [](Executor &e, double v) { e.set_returned(e.returned_value(), v != 0); }},
};

/// Nine axes each: the tool's position, and the offsets of the coordinate system and of G92.
struct AxisNames {
    std::array<std::string_view, geom::AXIS_COUNT> names;
    Pose State::*pose;
    bool isWritable;
};
constexpr AxisNames AXIS_ROWS[] = {
    {{"current_x", "current_y", "current_z", "AA_current", "BB_current", "CC_current", "u_current",
      "v_current", "w_current"},
     &State::position,
     true},
    {{"origin_offset_x", "origin_offset_y", "origin_offset_z", "AA_origin_offset", "BB_origin_offset",
      "CC_origin_offset", "u_origin_offset", "v_origin_offset", "w_origin_offset"},
     &State::g5x,
     false},
    {{"axis_offset_x", "axis_offset_y", "axis_offset_z", "AA_axis_offset", "BB_axis_offset", "CC_axis_offset",
      "u_axis_offset", "v_axis_offset", "w_axis_offset"},
     &State::g92,
     false},
    {{"program_x", "program_y", "program_z", "", "", "", "", "", ""}, &State::position, false},
};

const Row *find_row(std::string_view name) {
    for (const std::span<const Row> rows : {std::span<const Row>(MODES), std::span<const Row>(CYCLES),
                                            std::span<const Row>(TOOLS), std::span<const Row>(REST)}) {
        const auto found = std::ranges::find(rows, name, &Row::name);
        if (found != rows.end()) {
            return &*found;
        }
    }
    return nullptr;
}

struct AxisPlace {
    const AxisNames *row = nullptr;
    int axis = 0;
};

AxisPlace find_axis(std::string_view name) {
    for (const AxisNames &row : AXIS_ROWS) {
        const auto found = std::ranges::find(row.names, name);
        if (found != row.names.end() && !name.empty()) {
            return {&row, static_cast<int>(found - row.names.begin())};
        }
    }
    return {};
}

std::optional<double> number_of(const ScriptValue &value) {
    if (const bool *flag = std::get_if<bool>(&value)) {
        return *flag ? 1.0 : 0.0;
    }
    if (const std::int64_t *number = std::get_if<std::int64_t>(&value)) {
        return static_cast<double>(*number);
    }
    const double *real = std::get_if<double>(&value);
    return real != nullptr && std::isfinite(*real) ? std::optional<double>(*real) : std::nullopt;
}

}  // namespace

std::optional<ScriptValue> Executor::attribute(std::string_view name) const {
    if (const Row *row = find_row(name); row != nullptr) {
        return row->read(*this);
    }
    const AxisPlace place = find_axis(name);
    return place.row == nullptr ? std::nullopt
                                : std::optional<ScriptValue>((state.*place.row->pose)[place.axis]);
}

Result<> Executor::set_attribute(std::string_view name, const ScriptValue &value) {
    const Row *row = find_row(name);
    const AxisPlace place = find_axis(name);
    const bool isWritable =
        row != nullptr ? row->write != nullptr : place.row != nullptr && place.row->isWritable;
    if (!isWritable) {
        return fail(fmt::format("{} cannot be set", name));
    }
    const std::optional<double> number = number_of(value);
    if (!number) {
        return fail(fmt::format("{} needs a finite number", name));
    }
    if (row != nullptr) {
        row->write(*this, *number);
    } else {
        (state.*place.row->pose)[place.axis] = *number;
    }
    return {};
}

std::vector<std::string_view> Executor::attribute_names() {
    std::vector<std::string_view> out;
    for (const std::span<const Row> rows : {std::span<const Row>(MODES), std::span<const Row>(CYCLES),
                                            std::span<const Row>(TOOLS), std::span<const Row>(REST)}) {
        for (const Row &row : rows) {
            out.push_back(row.name);
        }
    }
    for (const AxisNames &row : AXIS_ROWS) {
        std::ranges::copy_if(row.names, std::back_inserter(out),
                             [](std::string_view n) { return !n.empty(); });
    }
    return out;
}

void Executor::load_indexed_tool() {
    const bool isInTable = state.tool_index >= 0 && state.tool_index < tools_.count();
    load_tool(isInTable ? state.tool_index : 0);
}

void Executor::set_tool_offset(const Pose &offset) {
    Frame made = frame();
    made.tool = offset;
    change_frame(made);
}

/// As scripts number the planes.
int Executor::plane_number() const {
    switch (state.plane) {
    case Plane::XY: return 1;
    case Plane::YZ: return 2;
    case Plane::XZ: return 3;
    case Plane::UV: return 4;
    case Plane::VW: return 5;
    case Plane::UW: return 6;
    }
    return 1;
}

}  // namespace mw::interp::detail

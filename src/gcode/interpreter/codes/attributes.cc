// SPDX-License-Identifier: GPL-2.0-or-later
// One row for each name.
#include "gcode/interpreter/codes/attributes.hh"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <span>

#include <fmt/format.h>

namespace mw::gcode::detail {
namespace {

using Sources = AttributeSources;
using Reader = ScriptValue (*)(const Sources &sources);
using Writer = void (*)(const Sources &sources, double value);

struct Row {
    std::string_view name;
    Reader read;
    Writer write = nullptr;  ///< null: read-only
};

std::int64_t whole(int value) {
    return value;
}

/// Units in the numbering of scripts.
int unit_number(LengthUnits units) {
    return units == LengthUnits::INCH ? 1 : 2;
}

/// Planes in the numbering of scripts.
int plane_number(Plane plane) {
    switch (plane) {
    case Plane::XY: return 1;
    case Plane::YZ: return 2;
    case Plane::XZ: return 3;
    case Plane::UV: return 4;
    case Plane::VW: return 5;
    case Plane::UW: return 6;
    }
    return 1;
}

int side_number(CompSide side) {
    return side == CompSide::OFF ? 0 : (side == CompSide::RIGHT ? 1 : 2);
}

int to_whole(double value) {
    constexpr double MOST = 2147483647.0;
    return static_cast<int>(std::lround(std::clamp(value, -MOST, MOST)));
}

SpindleState &spindle(const Sources &e) {
    return e.state.spindles[static_cast<std::size_t>(e.state.active_spindle)];
}

constexpr Row MODES[] = {
    {"active_spindle", [](const Sources &e) -> ScriptValue { return whole(e.state.active_spindle); },
     [](const Sources &e, double v) {
         e.state.active_spindle = std::clamp(to_whole(v), 0, e.parts.world.count_spindles() - 1);
     }},
    {"arc_not_allowed", [](const Sources &e) -> ScriptValue { return e.state.comp.isExit(); },
     [](const Sources &e, double v) { e.state.comp.set_exit(v != 0); }},
    {"cutter_comp_firstmove", [](const Sources &e) -> ScriptValue { return !e.state.comp.hasMoved(); }},
    {"cutter_comp_orientation",
     [](const Sources &e) -> ScriptValue { return whole(e.state.comp.orientation()); }},
    {"cutter_comp_radius", [](const Sources &e) -> ScriptValue { return e.state.comp.radius(); }},
    {"cutter_comp_side",
     [](const Sources &e) -> ScriptValue { return whole(side_number(e.state.comp.side())); }},
    {"distance_mode", [](const Sources &e) -> ScriptValue { return whole(e.state.incremental ? 1 : 0); },
     [](const Sources &e, double v) { e.state.incremental = v != 0; }},
    {"feed_mode", [](const Sources &e) -> ScriptValue { return whole(static_cast<int>(e.state.feed_mode)); },
     [](const Sources &e, double v) {
         e.state.feed_mode = static_cast<FeedMode>(std::clamp(to_whole(v), 0, 2));
     }},
    {"feed_override", [](const Sources &e) -> ScriptValue { return e.state.is_feed_override; },
     [](const Sources &e, double v) { e.state.is_feed_override = v != 0; }},
    {"feed_rate", [](const Sources &e) -> ScriptValue { return e.state.feed; },
     [](const Sources &e, double v) {
         e.state.feed = v;
         e.state.feed_units = e.state.units;
     }},
    {"flood", [](const Sources &e) -> ScriptValue { return e.state.isFlood; },
     [](const Sources &e, double v) { e.state.isFlood = v != 0; }},
    {"ijk_distance_mode",
     [](const Sources &e) -> ScriptValue { return whole(e.state.centre_absolute ? 0 : 1); },
     [](const Sources &e, double v) { e.state.centre_absolute = v == 0; }},
    {"length_units", [](const Sources &e) -> ScriptValue { return whole(unit_number(e.state.units)); }},
    {"mist", [](const Sources &e) -> ScriptValue { return e.state.isMist; },
     [](const Sources &e, double v) { e.state.isMist = v != 0; }},
    {"motion_mode", [](const Sources &e) -> ScriptValue { return whole(number_of(e.state.motion)); },
     [](const Sources &e, double v) { e.state.motion = make_code('g', std::min(to_whole(v), M_CODES - 1)); }},
    {"origin_index", [](const Sources &e) -> ScriptValue { return whole(e.state.g5x_index); }},
    {"plane", [](const Sources &e) -> ScriptValue { return whole(plane_number(e.state.plane)); }},
    {"retract_mode", [](const Sources &e) -> ScriptValue { return whole(e.state.retract_to_r ? 0 : 1); },
     [](const Sources &e, double v) { e.state.retract_to_r = v == 0; }},
    {"rotation_xy", [](const Sources &e) -> ScriptValue { return e.state.frame.rotation_deg; }},
    {"speed_feed_mode", [](const Sources &) -> ScriptValue { return whole(2); }},
    {"speed_override", [](const Sources &e) -> ScriptValue { return spindle(e).overridden; },
     [](const Sources &e, double v) { spindle(e).overridden = v != 0; }},
    {"spindle_mode",
     [](const Sources &e) -> ScriptValue { return whole(spindle(e).is_constant_surface ? 1 : 0); }},
    {"spindle_turning",
     [](const Sources &e) -> ScriptValue {
         constexpr std::array<int, 3> NUMBERS{3, 1, 2};  // counterclockwise, stopped, clockwise
         return whole(NUMBERS[static_cast<std::size_t>(spindle(e).direction + 1)]);
     }},
    {"traverse_rate", [](const Sources &) -> ScriptValue { return 0.0; }},
};

constexpr Row CYCLES[] = {
    {"cycle_cc", [](const Sources &e) -> ScriptValue { return e.state.cycle.bottom; },
     [](const Sources &e, double v) { e.state.cycle.bottom = v; }},
    {"cycle_i", [](const Sources &e) -> ScriptValue { return e.state.cycle.i; },
     [](const Sources &e, double v) { e.state.cycle.i = v; }},
    {"cycle_il", [](const Sources &e) -> ScriptValue { return e.state.cycle.initial; },
     [](const Sources &e, double v) { e.state.cycle.initial = v; }},
    {"cycle_il_flag", [](const Sources &e) -> ScriptValue { return whole(e.state.cycle.running ? 1 : 0); },
     [](const Sources &e, double v) { e.state.cycle.running = v != 0; }},
    {"cycle_j", [](const Sources &e) -> ScriptValue { return e.state.cycle.j; },
     [](const Sources &e, double v) { e.state.cycle.j = v; }},
    {"cycle_k", [](const Sources &e) -> ScriptValue { return e.state.cycle.k; },
     [](const Sources &e, double v) { e.state.cycle.k = v; }},
    {"cycle_l", [](const Sources &) -> ScriptValue { return whole(0); }},
    {"cycle_p", [](const Sources &e) -> ScriptValue { return e.state.cycle.p; },
     [](const Sources &e, double v) { e.state.cycle.p = v; }},
    {"cycle_q", [](const Sources &e) -> ScriptValue { return e.state.cycle.q; },
     [](const Sources &e, double v) { e.state.cycle.q = v; }},
    {"cycle_r", [](const Sources &e) -> ScriptValue { return e.state.cycle.r; },
     [](const Sources &e, double v) { e.state.cycle.r = v; }},
};

constexpr Row TOOLS[] = {
    {"current_pocket", [](const Sources &e) -> ScriptValue { return whole(e.state.tool.index); },
     [](const Sources &e, double v) { e.state.tool.index = to_whole(v); }},
    {"current_tool", [](const Sources &e) -> ScriptValue { return whole(e.state.tool.in_spindle); },
     [](const Sources &e, double v) { e.state.tool.in_spindle = to_whole(v); }},
    {"random_toolchanger",
     [](const Sources &e) -> ScriptValue { return whole(e.parts.tools.isRandom() ? 1 : 0); }},
    {"selected_pocket", [](const Sources &e) -> ScriptValue { return whole(e.state.tool.selected_index); },
     [](const Sources &e, double v) { e.state.tool.selected_index = to_whole(v); }},
    {"selected_tool", [](const Sources &e) -> ScriptValue { return whole(e.state.tool.selected); },
     [](const Sources &e, double v) { e.state.tool.selected = to_whole(v); }},
    {"tool_change_at_g30", [](const Sources &) -> ScriptValue { return whole(0); }},
    {"tool_change_quill_up", [](const Sources &) -> ScriptValue { return whole(0); }},
    {"tool_change_with_spindle_on", [](const Sources &) -> ScriptValue { return whole(0); }},
    {"toolchange_flag", [](const Sources &e) -> ScriptValue { return e.parts.awaited.is_tool_change; },
     [](const Sources &e, double v) { e.parts.awaited.is_tool_change = v != 0; }},
};

constexpr Row REST[] = {
    {"a_axis_wrapped",
     [](const Sources &e) -> ScriptValue {
         return whole(e.state.rotary.isWrapped(geometry::AXIS_A) ? 1 : 0);
     }},
    {"a_indexer_jnum",
     [](const Sources &e) -> ScriptValue { return whole(e.state.rotary.indexer_joint(geometry::AXIS_A)); }},
    {"b_axis_wrapped",
     [](const Sources &e) -> ScriptValue {
         return whole(e.state.rotary.isWrapped(geometry::AXIS_B) ? 1 : 0);
     }},
    {"b_indexer_jnum",
     [](const Sources &e) -> ScriptValue { return whole(e.state.rotary.indexer_joint(geometry::AXIS_B)); }},
    {"c_axis_wrapped",
     [](const Sources &e) -> ScriptValue {
         return whole(e.state.rotary.isWrapped(geometry::AXIS_C) ? 1 : 0);
     }},
    {"c_indexer_jnum",
     [](const Sources &e) -> ScriptValue { return whole(e.state.rotary.indexer_joint(geometry::AXIS_C)); }},
    {"debugmask", [](const Sources &e) -> ScriptValue { return whole(e.script_levels.debug_mask); },
     [](const Sources &e, double v) { e.script_levels.debug_mask = to_whole(v); }},
    {"input_digital", [](const Sources &) -> ScriptValue { return false; }},
    {"input_flag", [](const Sources &e) -> ScriptValue { return e.parts.awaited.is_input; },
     [](const Sources &e, double v) { e.parts.awaited.is_input = v != 0; }},
    {"input_index", [](const Sources &) -> ScriptValue { return whole(-1); }},
    {"loggingLevel", [](const Sources &e) -> ScriptValue { return whole(e.script_levels.logging_level); },
     [](const Sources &e, double v) { e.script_levels.logging_level = to_whole(v); }},
    {"mdi_interrupt", [](const Sources &) -> ScriptValue { return false; }},
    {"num_spindles", [](const Sources &e) -> ScriptValue { return whole(e.parts.world.count_spindles()); }},
    {"probe_flag", [](const Sources &e) -> ScriptValue { return e.parts.awaited.isProbe; },
     [](const Sources &e, double v) { e.parts.awaited.isProbe = v != 0; }},
    {"remap_level", [](const Sources &e) -> ScriptValue { return whole(e.running_remaps); }},
    {"return_value", [](const Sources &e) -> ScriptValue { return e.returned.value; },
     [](const Sources &e, double v) { e.returned.value = v; }},
    {"sequence_number", [](const Sources &e) -> ScriptValue { return whole(e.parts.place.line); }},
    {"task", [](const Sources &e) -> ScriptValue { return whole(e.parts.settings.is_task ? 1 : 0); }},
    {"value_returned", [](const Sources &e) -> ScriptValue { return whole(e.returned.set ? 1 : 0); },
     [](const Sources &e, double v) { e.returned.set = v != 0; }},
};

/// Nine axes each: the tool's position, and the offsets of the coordinate system and of G92.
struct AxisNames {
    std::array<std::string_view, geometry::AXIS_COUNT> names;
    const Pose &(*read)(const State &state);
    void (*write)(State &state, int axis, double value) = nullptr;
};
constexpr AxisNames AXIS_ROWS[] = {
    {{"current_x", "current_y", "current_z", "AA_current", "BB_current", "CC_current", "u_current",
      "v_current", "w_current"},
     [](const State &state) -> const Pose & { return state.position; },
     [](State &state, int axis, double value) { state.position[axis] = value; }},
    {{"origin_offset_x", "origin_offset_y", "origin_offset_z", "AA_origin_offset", "BB_origin_offset",
      "CC_origin_offset", "u_origin_offset", "v_origin_offset", "w_origin_offset"},
     [](const State &state) -> const Pose & { return state.frame.g5x; }},
    {{"axis_offset_x", "axis_offset_y", "axis_offset_z", "AA_axis_offset", "BB_axis_offset", "CC_axis_offset",
      "u_axis_offset", "v_axis_offset", "w_axis_offset"},
     [](const State &state) -> const Pose & { return state.frame.g92; }},
    {{"program_x", "program_y", "program_z", "", "", "", "", "", ""},
     [](const State &state) -> const Pose & { return state.position; }},
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

std::optional<ScriptValue> attribute(std::string_view name, const AttributeSources &sources) {
    if (const Row *row = find_row(name); row != nullptr) {
        return row->read(sources);
    }
    const AxisPlace place = find_axis(name);
    return place.row == nullptr ? std::nullopt
                                : std::optional<ScriptValue>(place.row->read(sources.state)[place.axis]);
}

Result<> set_attribute(std::string_view name, const ScriptValue &value, const AttributeSources &sources) {
    const Row *row = find_row(name);
    const AxisPlace place = find_axis(name);
    const bool writable =
        row != nullptr ? row->write != nullptr : place.row != nullptr && place.row->write != nullptr;
    if (!writable) {
        return fail(fmt::format("{} cannot be set", name));
    }
    const std::optional<double> number = number_of(value);
    if (!number) {
        return fail(fmt::format("{} needs a finite number", name));
    }
    if (row != nullptr) {
        row->write(sources, *number);
    } else {
        place.row->write(sources.state, place.axis, *number);
    }
    return {};
}

std::vector<std::string_view> attribute_names() {
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

}  // namespace mw::gcode::detail

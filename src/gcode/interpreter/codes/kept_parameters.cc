// SPDX-License-Identifier: GPL-2.0-or-later
// One row for each name.
#include "gcode/interpreter/codes/kept_parameters.hh"

#include <algorithm>
#include <array>

#include "gcode/canon/frame.hh"
#include "gcode/interpreter/codes/active_codes.hh"
#include "gcode/interpreter/expressions/parameters.hh"

namespace mw::gcode::detail {
namespace {

constexpr int AXES_OF_POSE = geometry::AXIS_COUNT;

using Sources = KeptSources;
using Reader = double (*)(const Sources &sources);

double flag(bool set) {
    return set ? 1.0 : 0.0;
}

/// Pocket number of the entry at `index`, -1 for none; 0 is the spindle of a random changer.
double pocket_at(const Sources &e, int index) {
    const ToolTable &tools = e.parts.tools;
    if (index < 0 || index >= tools.count()) {
        return index;
    }
    const ToolEntry entry = tools.entry(index);
    return index > 0 ? entry.pocketno : tools.isRandom() && entry.toolno >= 0 ? 0 : -1;
}

struct Row {
    std::string_view name;
    Reader read;
};

const SpindleState &spindle(const Sources &e) {
    return e.state.spindles[static_cast<std::size_t>(e.state.active_spindle)];
}

constexpr double VERSION_MAJOR = 2.9, VERSION_MINOR = 0.0;  // version of the dialect

// Name and location of the value.
constexpr Row ROWS[] = {
    {"_vmajor", [](const Sources &) { return VERSION_MAJOR; }},
    {"_vminor", [](const Sources &) { return VERSION_MINOR; }},
    {"_line", [](const Sources &e) { return static_cast<double>(e.parts.place.line); }},
    {"_motion_mode", [](const Sources &e) { return static_cast<double>(number_of(e.state.motion)); }},
    {"_plane", [](const Sources &e) { return static_cast<double>(number_of(plane_code(e.state.plane))); }},
    {"_ccomp", [](const Sources &e) { return static_cast<double>(number_of(e.state.comp.code())); }},
    {"_metric", [](const Sources &e) { return flag(e.state.units == LengthUnits::MM); }},
    {"_metric_machine",
     [](const Sources &e) { return flag(e.parts.world.machine_units() == LengthUnits::MM); }},
    {"_imperial", [](const Sources &e) { return flag(e.state.units == LengthUnits::INCH); }},
    {"_absolute", [](const Sources &e) { return flag(!e.state.incremental); }},
    {"_incremental", [](const Sources &e) { return flag(e.state.incremental); }},
    {"_inverse_time", [](const Sources &e) { return flag(e.state.feed_mode == FeedMode::INVERSE_TIME); }},
    {"_units_per_minute",
     [](const Sources &e) { return flag(e.state.feed_mode == FeedMode::UNITS_PER_MINUTE); }},
    {"_units_per_rev",
     [](const Sources &e) { return flag(e.state.feed_mode == FeedMode::UNITS_PER_REVOLUTION); }},
    {"_coord_system",
     [](const Sources &e) {
         return static_cast<double>(number_of(coordinate_system_code(e.state.g5x_index)));
     }},
    {"_tool_offset", [](const Sources &e) { return flag(e.state.tool.offset_code != G(49)); }},
    {"_retract_r_plane", [](const Sources &e) { return flag(e.state.retract_to_r); }},
    {"_retract_old_z", [](const Sources &e) { return flag(!e.state.retract_to_r); }},
    {"_spindle_rpm_mode", [](const Sources &e) { return flag(!spindle(e).is_constant_surface); }},
    {"_spindle_css_mode", [](const Sources &e) { return flag(spindle(e).is_constant_surface); }},
    {"_ijk_absolute_mode", [](const Sources &e) { return flag(e.state.centre_absolute); }},
    {"_lathe_diameter_mode", [](const Sources &e) { return flag(e.state.isDiameter); }},
    {"_lathe_radius_mode", [](const Sources &e) { return flag(!e.state.isDiameter); }},
    {"_spindle_on", [](const Sources &e) { return flag(spindle(e).direction != 0); }},
    {"_spindle_cw", [](const Sources &e) { return flag(spindle(e).direction > 0); }},
    {"_mist", [](const Sources &e) { return flag(e.state.isMist); }},
    {"_flood", [](const Sources &e) { return flag(e.state.isFlood); }},
    {"_speed_override", [](const Sources &e) { return flag(spindle(e).overridden); }},
    {"_feed_override", [](const Sources &e) { return flag(e.state.is_feed_override); }},
    {"_adaptive_feed", [](const Sources &e) { return flag(e.state.adaptive); }},
    {"_feed_hold", [](const Sources &e) { return flag(e.state.is_feed_hold); }},
    {"_feed", [](const Sources &e) { return e.state.feed; }},
    {"_rpm", [](const Sources &e) { return spindle(e).speed; }},
    {"_current_tool", [](const Sources &e) { return static_cast<double>(e.state.tool.in_spindle); }},
    {"_current_pocket", [](const Sources &e) { return pocket_at(e, e.state.tool.index); }},
    {"_selected_tool", [](const Sources &e) { return static_cast<double>(e.state.tool.selected); }},
    {"_selected_pocket", [](const Sources &e) { return pocket_at(e, e.state.tool.selected_index); }},
    {"_value", [](const Sources &e) { return e.returned.value; }},
    {"_value_returned", [](const Sources &e) { return flag(e.returned.set); }},
    {"_task", [](const Sources &e) { return flag(e.parts.settings.is_task); }},
    {"_call_level", [](const Sources &e) { return static_cast<double>(e.parts.place.call_level); }},
    {"_remap_level", [](const Sources &e) { return static_cast<double>(e.running_remaps); }},
};

const Row *find_row(std::string_view name) {
    for (const Row &row : ROWS) {
        if (row.name == name) {
            return &row;
        }
    }
    return nullptr;
}

/// "_x" to "_w": 0 to 8; "_abs_x" to "_abs_w": 9 to 17; -1 otherwise.
int position_index(std::string_view name) {
    const bool is_machine = name.starts_with("_abs_");
    const std::string_view axis = name.substr(is_machine ? 5 : 1);
    if (axis.size() != 1) {
        return -1;
    }
    const int index = geometry::axis_of_letter(axis[0]);
    return index < 0 ? -1 : index + (is_machine ? AXES_OF_POSE : 0);
}

Pose on_machine(const Sources &sources) {
    const State &state = sources.state;
    return state.frame.to_machine(sources.position);
}

}  // namespace

std::vector<std::string> kept_names() {
    std::vector<std::string> out;
    for (const Row &row : ROWS) {
        out.emplace_back(row.name);
    }
    for (const char axis : std::string_view(geometry::AXIS_LETTERS_LOWER, AXES_OF_POSE)) {
        out.push_back(std::string("_") + axis);
        out.push_back(std::string("_abs_") + axis);
    }
    std::ranges::sort(out);
    return out;
}

bool isKeptName(std::string_view name) {
    return position_index(name) >= 0 || find_row(name) != nullptr;
}

std::optional<double> kept_value(std::string_view name, const KeptSources &sources) {
    if (const int index = position_index(name); index >= 0) {
        return index < AXES_OF_POSE ? sources.position[index] : on_machine(sources)[index - AXES_OF_POSE];
    }
    const Row *row = find_row(name);
    return row == nullptr ? std::nullopt : std::optional<double>(row->read(sources));
}

double kept_value(int number, const KeptSources &sources) {
    const State &state = sources.state;
    if (number >= P_POSITION && number < P_POSITION + AXES_OF_POSE) {
        return sources.position[number - P_POSITION];
    }
    if (number >= P_TOOL_OFFSET && number < P_TOOL_OFFSET + AXES_OF_POSE) {
        return state.tool.offset[number - P_TOOL_OFFSET];
    }
    if (number >= P_MACHINE_POSITION && number < P_MACHINE_POSITION + AXES_OF_POSE) {
        return on_machine(sources)[number - P_MACHINE_POSITION];
    }
    switch (number) {
    case P_TOOL_NUMBER: return state.tool.in_spindle;
    case P_TOOL_DIAMETER: return state.tool.diameter;
    case P_TOOL_FRONTANGLE: return state.tool.frontangle;
    case P_TOOL_BACKANGLE: return state.tool.backangle;
    case P_TOOL_ORIENTATION: return state.tool.orientation;
    default: return sources.parts.parameters.get(number);
    }
}

}  // namespace mw::gcode::detail

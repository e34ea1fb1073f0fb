// SPDX-License-Identifier: GPL-2.0-or-later
// Parameters that the interpreter keeps: #<_name> and #5400 to #5428.
#include <algorithm>
#include <array>

#include "base/text.hh"
#include "interp/codes/executor.hh"

namespace mw::interp::detail {
namespace {

constexpr int AXES_OF_POSE = geom::AXIS_COUNT;

using Reader = double (*)(const Executor &executor);

double flag(bool isSet) {
    return isSet ? 1.0 : 0.0;
}

struct Row {
    std::string_view name;
    Reader read;
};

const SpindleState &spindle(const Executor &e) {
    return e.state.spindles[static_cast<std::size_t>(e.state.active_spindle)];
}

constexpr double VERSION_MAJOR = 2.9, VERSION_MINOR = 0.0;  // of the dialect

// Name and where its value is.
constexpr Row ROWS[] = {
    {"_vmajor", [](const Executor &) { return VERSION_MAJOR; }},
    {"_vminor", [](const Executor &) { return VERSION_MINOR; }},
    {"_line", [](const Executor &e) { return static_cast<double>(e.line()); }},
    {"_motion_mode", [](const Executor &e) { return static_cast<double>(e.state.motion); }},
    {"_plane", [](const Executor &e) { return static_cast<double>(e.plane_code()); }},
    {"_ccomp", [](const Executor &e) { return static_cast<double>(e.state.comp_code); }},
    {"_metric", [](const Executor &e) { return flag(e.state.units == LengthUnits::MM); }},
    {"_metric_machine", [](const Executor &e) { return flag(e.world().machine_units() == LengthUnits::MM); }},
    {"_imperial", [](const Executor &e) { return flag(e.state.units == LengthUnits::INCH); }},
    {"_absolute", [](const Executor &e) { return flag(!e.state.isIncremental); }},
    {"_incremental", [](const Executor &e) { return flag(e.state.isIncremental); }},
    {"_inverse_time", [](const Executor &e) { return flag(e.state.feed_mode == FeedMode::INVERSE_TIME); }},
    {"_units_per_minute",
     [](const Executor &e) { return flag(e.state.feed_mode == FeedMode::UNITS_PER_MINUTE); }},
    {"_units_per_rev",
     [](const Executor &e) { return flag(e.state.feed_mode == FeedMode::UNITS_PER_REVOLUTION); }},
    {"_coord_system", [](const Executor &e) { return static_cast<double>(e.coordinate_system_code()); }},
    {"_tool_offset", [](const Executor &e) { return flag(e.state.tool_offset_code != 490); }},
    {"_retract_r_plane", [](const Executor &e) { return flag(e.state.isRetractToR); }},
    {"_retract_old_z", [](const Executor &e) { return flag(!e.state.isRetractToR); }},
    {"_spindle_rpm_mode", [](const Executor &e) { return flag(!spindle(e).isConstantSurface); }},
    {"_spindle_css_mode", [](const Executor &e) { return flag(spindle(e).isConstantSurface); }},
    {"_ijk_absolute_mode", [](const Executor &e) { return flag(e.state.isCentreAbsolute); }},
    {"_lathe_diameter_mode", [](const Executor &e) { return flag(e.state.isDiameter); }},
    {"_lathe_radius_mode", [](const Executor &e) { return flag(!e.state.isDiameter); }},
    {"_spindle_on", [](const Executor &e) { return flag(spindle(e).direction != 0); }},
    {"_spindle_cw", [](const Executor &e) { return flag(spindle(e).direction > 0); }},
    {"_mist", [](const Executor &e) { return flag(e.state.isMist); }},
    {"_flood", [](const Executor &e) { return flag(e.state.isFlood); }},
    {"_speed_override", [](const Executor &e) { return flag(spindle(e).isOverridden); }},
    {"_feed_override", [](const Executor &e) { return flag(e.state.isFeedOverride); }},
    {"_adaptive_feed", [](const Executor &e) { return flag(e.state.isAdaptive); }},
    {"_feed_hold", [](const Executor &e) { return flag(e.state.isFeedHold); }},
    {"_feed", [](const Executor &e) { return e.state.feed; }},
    {"_rpm", [](const Executor &e) { return spindle(e).speed; }},
    {"_current_tool", [](const Executor &e) { return static_cast<double>(e.state.tool_in_spindle); }},
    {"_current_pocket", [](const Executor &e) { return static_cast<double>(e.state.tool_index); }},
    {"_selected_tool", [](const Executor &e) { return static_cast<double>(e.state.selected_tool); }},
    {"_selected_pocket", [](const Executor &e) { return static_cast<double>(e.state.selected_index); }},
    {"_value", [](const Executor &e) { return e.returned_value(); }},
    {"_value_returned", [](const Executor &e) { return flag(e.isValueReturned()); }},
    {"_task", [](const Executor &e) { return flag(e.settings().isTask); }},
    {"_call_level", [](const Executor &e) { return static_cast<double>(e.call_level()); }},
    {"_remap_level", [](const Executor &e) { return static_cast<double>(e.remap_level()); }},
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
    const bool isMachine = name.starts_with("_abs_");
    const std::string_view axis = name.substr(isMachine ? 5 : 1);
    if (axis.size() != 1) {
        return -1;
    }
    const int index = geom::axis_of_letter(axis[0]);
    return index < 0 ? -1 : index + (isMachine ? AXES_OF_POSE : 0);
}

bool isIniName(std::string_view name) {
    return name.starts_with("_ini[");
}

bool isHalName(std::string_view name) {
    return name.starts_with("_hal[");
}

}  // namespace

std::vector<std::string> Executor::predefined_names() {
    std::vector<std::string> out;
    for (const Row &row : ROWS) {
        out.emplace_back(row.name);
    }
    for (const char axis : std::string_view(geom::AXIS_LETTERS_LOWER, AXES_OF_POSE)) {
        out.push_back(std::string("_") + axis);
        out.push_back(std::string("_abs_") + axis);
    }
    std::ranges::sort(out);
    return out;
}

bool Executor::isBuiltInName(std::string_view name) const {
    if (script_names_ != nullptr && script_names_->hasName(name)) {
        return true;
    }
    return isIniName(name) || isHalName(name) || position_index(name) >= 0 || find_row(name) != nullptr;
}

std::optional<double> Executor::built_in(std::string_view name) const {
    if (script_names_ != nullptr && script_names_->hasName(name)) {
        return script_names_->value_of(name);
    }
    if (isIniName(name)) {
        const std::size_t close = name.find(']');
        if (close == std::string_view::npos || !settings_.isIniReadable) {
            return std::nullopt;
        }
        const auto value = source_.ini_value(name.substr(5, close - 5), name.substr(close + 1));
        if (value && !ini_names_read_.contains(name)) {
            ini_names_read_.emplace(name);
        }
        return value;
    }
    if (isHalName(name)) {
        if (!settings_.isHalReadable) {
            return std::nullopt;
        }
        return source_.hal_value(name.substr(5, name.find(']') - 5));
    }
    if (const int index = position_index(name); index >= 0) {
        if (index < AXES_OF_POSE) {
            return reported_position()[index];
        }
        return frame().to_machine(reported_position())[index - AXES_OF_POSE];
    }
    const Row *row = find_row(name);
    return row == nullptr ? std::nullopt : std::optional<double>(row->read(*this));
}

double Executor::built_in(int number) const {
    if (number >= P_POSITION && number < P_POSITION + AXES_OF_POSE) {
        return reported_position()[number - P_POSITION];
    }
    if (number >= P_TOOL_OFFSET && number < P_TOOL_OFFSET + AXES_OF_POSE) {
        return state.loaded_offset[number - P_TOOL_OFFSET];
    }
    if (number >= P_MACHINE_POSITION && number < P_MACHINE_POSITION + AXES_OF_POSE) {
        return frame().to_machine(reported_position())[number - P_MACHINE_POSITION];
    }
    switch (number) {
    case P_TOOL_NUMBER: return state.tool_in_spindle;
    case P_TOOL_DIAMETER: return state.tool_diameter;
    case P_TOOL_FRONTANGLE: return state.tool_frontangle;
    case P_TOOL_BACKANGLE: return state.tool_backangle;
    case P_TOOL_ORIENTATION: return state.tool_orientation;
    default: return parameters.get(number);
    }
}

/// Where the tool is, compensation included.
Pose Executor::reported_position() const {
    const bool isShifted = state.comp != CompSide::OFF && state.comp_last.isSet;
    return isShifted ? in_plane(state.position, state.comp_last.end) : state.position;
}

int Executor::coordinate_system_code() const {
    return state.g5x_index <= 6 ? 530 + 10 * state.g5x_index : 584 + state.g5x_index;
}

}  // namespace mw::interp::detail

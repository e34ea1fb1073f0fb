// SPDX-License-Identifier: GPL-2.0-or-later
// What programs and scripts read of the executor, and scripts change.
#include "interp/codes/executor.hh"

namespace mw::interp::detail {
namespace {

bool isIniName(std::string_view name) {
    return name.starts_with("_ini[");
}

bool isHalName(std::string_view name) {
    return name.starts_with("_hal[");
}

}  // namespace

AttributeSources Executor::attribute_sources() {
    return {state,           returned, awaited, script_levels,
            block_place,     world_,   tools_,  remaps.count_running(),
            settings_.isTask};
}

KeptSources Executor::kept_sources() const {
    return {state,
            returned,
            block_place,
            parameters,
            world_,
            reported_position(),
            remaps.count_running(),
            settings_.isTask};
}

bool Executor::isBuiltInName(std::string_view name) const {
    if (script_names_ != nullptr && script_names_->hasName(name)) {
        return true;
    }
    return isIniName(name) || isHalName(name) || isKeptName(name);
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
    return kept_value(name, kept_sources());
}

double Executor::built_in(int number) const {
    return kept_value(number, kept_sources());
}

/// Where the tool is, compensation included.
Pose Executor::reported_position() const {
    const bool isShifted = state.comp != CompSide::OFF && state.comp_last.isSet;
    return isShifted ? in_plane(state.position, state.comp_last.end) : state.position;
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

}  // namespace mw::interp::detail

// SPDX-License-Identifier: GPL-2.0-or-later
// State of the executor that programs and scripts read or change.
#include "gcode/interpreter/codes/executor.hh"

namespace mw::gcode::detail {
namespace {

bool isIniName(std::string_view name) {
    return name.starts_with("_ini[");
}

bool isHalName(std::string_view name) {
    return name.starts_with("_hal[");
}

}  // namespace

AttributeSources Executor::attribute_sources() {
    return {state,
            returned,
            awaited,
            script_levels,
            block_place,
            parts.world,
            tools,
            remaps.count_running(),
            parts.settings.is_task};
}

KeptSources Executor::kept_sources() const {
    return {state,
            returned,
            block_place,
            parameters,
            parts.world,
            state.comp.compensated(state.position, state.plane),
            remaps.count_running(),
            parts.settings.is_task,
            &tools};
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
        if (close == std::string_view::npos || !parts.settings.ini_readable) {
            return std::nullopt;
        }
        const auto value = source_.ini_value(name.substr(5, close - 5), name.substr(close + 1));
        if (value && !ini_names_read_.contains(name)) {
            ini_names_read_.emplace(name);
        }
        return value;
    }
    if (isHalName(name)) {
        if (!parts.settings.hal_readable) {
            return std::nullopt;
        }
        return source_.hal_value(name.substr(5, name.find(']') - 5));
    }
    return kept_value(name, kept_sources());
}

double Executor::built_in(int number) const {
    return kept_value(number, kept_sources());
}

}  // namespace mw::gcode::detail

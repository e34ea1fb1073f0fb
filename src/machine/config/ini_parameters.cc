// SPDX-License-Identifier: GPL-2.0-or-later
#include "machine/config/ini_parameters.hh"

#include "base/text.hh"
#include "gcode/interpreter/ini_settings.hh"

namespace mw::machine {

std::optional<double> IniParameters::ini_value(std::string_view section, std::string_view key) const {
    return gcode::ini_number(ini_, section, key);
}

std::optional<double> IniParameters::hal_value(std::string_view name) const {
    if (hal_ == nullptr) {
        return std::nullopt;
    }
    // G-code ignores case: a key that does not exist as written may exist in lower case.
    for (const std::string &spelling : {std::string(name), to_lower(name)}) {
        auto value = hal_->values().get(spelling);
        if (!value.has_value()) {
            value = hal_->signals().get(spelling);
        }
        if (value.has_value()) {
            return value->as_number();
        }
    }
    return std::nullopt;
}

}  // namespace mw::machine

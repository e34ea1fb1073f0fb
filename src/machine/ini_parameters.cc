// SPDX-License-Identifier: GPL-2.0-or-later
#include "machine/ini_parameters.hh"

#include "interp/ini_settings.hh"

namespace mw::machine {

std::optional<double> IniParameters::ini_value(std::string_view section, std::string_view key) const {
    return interp::ini_number(ini_, section, key);
}

std::optional<double> IniParameters::hal_value(std::string_view name) const {
    if (hal_ == nullptr) {
        return std::nullopt;
    }
    auto value = hal_->get(name);
    if (!value.has_value()) {
        value = hal_->get_signal(name);
    }
    return value.has_value() ? std::optional<double>(value->as_number()) : std::nullopt;
}

}  // namespace mw::machine

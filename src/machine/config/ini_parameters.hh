// SPDX-License-Identifier: GPL-2.0-or-later
// #<_ini[SECTION]KEY> and #<_hal[NAME]> for programs.
#pragma once

#include "base/ini/ini_reader.hh"
#include "gcode/interpreter/world.hh"
#include "hal/core/hal.hh"

namespace mw::machine {

class IniParameters final : public gcode::ParameterSource {
  public:
    /// `hal` may be null: then HAL values are unknown.
    IniParameters(const ini::IniFile &ini, const hal::Hal *hal) : ini_(ini), hal_(hal) {}

    /// Section and key in upper or lower case, because G-code ignores case.
    std::optional<double> ini_value(std::string_view section, std::string_view key) const override;
    std::optional<double> hal_value(std::string_view name) const override;

  private:
    const ini::IniFile &ini_;
    const hal::Hal *hal_;
};

}  // namespace mw::machine

// SPDX-License-Identifier: GPL-2.0-or-later
// #<_ini[SECTION]KEY> and #<_hal[NAME]> for programs.
#pragma once

#include "base/ini/ini_reader.hh"
#include "gcode/interpreter/world.hh"
#include "hal/core/instance.hh"

namespace mw::machine {

class IniParameters final : public gcode::ParameterSource {
  public:
    /// If `hal` is null, HAL values are unknown.
    IniParameters(const ini::IniFile &ini, hal::Instance *hal) : ini_(ini), hal_(hal) {}

    /// Section and key in upper or lower case, because G-code ignores case.
    std::optional<double> ini_value(std::string_view section, std::string_view key) const override;
    std::optional<double> hal_value(std::string_view name) const override;

  private:
    const ini::IniFile &ini_;
    hal::Instance *hal_;
};

}  // namespace mw::machine

// SPDX-License-Identifier: GPL-2.0-or-later
// #<_ini[SECTION]KEY> and #<_hal[NAME]> for programs.
#pragma once

#include "config/ini_reader.hh"
#include "hal/core/hal.hh"
#include "interp/world.hh"

namespace mw::machine {

class IniParameters final : public interp::ParameterSource {
  public:
    /// `hal` may be null: then no HAL value is known.
    IniParameters(const config::IniFile &ini, const hal::Hal *hal) : ini_(ini), hal_(hal) {}

    /// Section and key in any case, as G-code has none.
    std::optional<double> ini_value(std::string_view section, std::string_view key) const override;
    std::optional<double> hal_value(std::string_view name) const override;

  private:
    const config::IniFile &ini_;
    const hal::Hal *hal_;
};

}  // namespace mw::machine

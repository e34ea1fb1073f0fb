// SPDX-License-Identifier: GPL-2.0-or-later
// What a screen has to know of the machine, from its INI file.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "base/diagnostics/sink.hh"
#include "clients/screen/machine_facts.hh"
#include "clients/screen/path_geometry.hh"
#include "machine/config/loaded_config.hh"

namespace mw::programs {

/// What cannot be read is warned of in `sink` and left out.
screen::MachineFacts machine_facts(const machine::LoadedConfig &loaded, diagnostics::Sink &sink);

/// The entries of [DISPLAY]INCREMENTS: "1 mm, .01 in, 1/8 in, 5 mil, 45 deg"; without commas blanks part
/// them. `unit_mm`: of the machine unit. What is none of these is in `bad`.
std::vector<screen::Increment> parse_increments(std::string_view text, double unit_mm,
                                                std::vector<std::string> &bad);

/// [DISPLAY]CYCLE_TIME: seconds, from 1 on milliseconds; 20 to 200 ms, 50 ms where it is not set. [s]
double status_period_s(const ini::IniFile &ini, diagnostics::Sink &sink);

/// How paths of programs are drawn.
screen::PathLook path_look(const screen::MachineFacts &facts);

}  // namespace mw::programs

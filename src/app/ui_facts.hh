// SPDX-License-Identifier: GPL-2.0-or-later
// What a screen has to know of the machine, from its INI file.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "diag/sink.hh"
#include "machine/loaded_config.hh"
#include "ui/web/machine_facts.hh"
#include "ui/web/path_geometry.hh"

namespace mw::app {

/// What cannot be read is warned of in `sink` and left out.
ui::web::MachineFacts machine_facts(const machine::LoadedConfig &loaded, diag::Sink &sink);

/// The entries of [DISPLAY]INCREMENTS: "1 mm, .01 in, 1/8 in, 5 mil, 45 deg"; without commas blanks part
/// them. `unit_mm`: of the machine unit. What is none of these is in `bad`.
std::vector<ui::web::Increment> parse_increments(std::string_view text, double unit_mm,
                                                 std::vector<std::string> &bad);

/// [DISPLAY]CYCLE_TIME: seconds, from 1 on milliseconds; 20 to 200 ms, 50 ms where it is not set. [s]
double status_period_s(const config::IniFile &ini, diag::Sink &sink);

/// How paths of programs are drawn.
ui::web::PathLook path_look(const ui::web::MachineFacts &facts);

}  // namespace mw::app

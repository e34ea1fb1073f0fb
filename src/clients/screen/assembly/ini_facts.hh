// SPDX-License-Identifier: GPL-2.0-or-later
// The data about the machine that a screen needs, from its INI file.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "base/diagnostics/sink.hh"
#include "clients/screen/facts/machine_facts.hh"
#include "clients/screen/path/path_geometry.hh"
#include "machine/config/loaded_config.hh"

namespace mw::screen {

/// Values that cannot be read are omitted, with a warning in `sink`.
MachineFacts machine_facts(const machine::LoadedConfig &loaded, diagnostics::Sink &sink);

/// The entries of [DISPLAY]INCREMENTS: "1 mm, .01 in, 1/8 in, 5 mil, 45 deg", separated by commas or blanks.
/// `unit_mm`: length of the machine unit. `bad` receives invalid entries.
std::vector<Increment> parse_increments(std::string_view text, double unit_mm, std::vector<std::string> &bad);

/// [DISPLAY]CYCLE_TIME: seconds, or milliseconds for values of 1 or more; 20 to 200 ms, 50 ms if it is not
/// set. [s]
double status_period_s(const ini::IniFile &ini, diagnostics::Sink &sink);

/// Drawing style of program paths.
PathLook path_look(const MachineFacts &facts);

}  // namespace mw::screen

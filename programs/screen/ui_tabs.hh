// SPDX-License-Identifier: GPL-2.0-or-later
// The shop's own panels of [DISPLAY]EMBED_TAB_..., and the programs that go with the screen.
#pragma once

#include <string>
#include <vector>

#include "base/diagnostics/sink.hh"
#include "base/ini/ini_file.hh"
#include "clients/screen/machine_facts.hh"

namespace mw::programs {

/// In their order. What has no command, or whose file cannot be read, is told as an error in `sink` and left
/// out.
std::vector<screen::Tab> tabs_of(const ini::IniFile &ini, diagnostics::Sink &sink);

/// The commands of tabs that are programs with windows of their own: a place in a window of X ({XID}) is
/// taken out, as a browser has none to give.
std::vector<std::string> tab_programs(const std::vector<screen::Tab> &tabs);

/// The commands that wait for the screen's pins, in their order: halcmd with each [HAL]POSTGUI_HALFILE,
/// haltcl with those of Tcl, then each [HAL]POSTGUI_HALCMD.
std::vector<std::vector<std::string>> postgui_commands(const ini::IniFile &ini, const std::string &programs);

/// Runs them one after the other and waits for each; failures are notes for the operator. An error ends none.
std::vector<std::string> run_postgui(const std::vector<std::vector<std::string>> &commands,
                                     const std::string &folder);

}  // namespace mw::programs

// SPDX-License-Identifier: GPL-2.0-or-later
// The user panels of [DISPLAY]EMBED_TAB_..., and the programs that belong to the screen.
#pragma once

#include <string>
#include <vector>

#include "base/diagnostics/sink.hh"
#include "base/ini/ini_file.hh"
#include "clients/screen/facts/machine_facts.hh"

namespace mw::programs {

/// The tabs in order. A tab without a command, or whose file cannot be read, is reported to `sink` as an
/// error and omitted.
std::vector<screen::Tab> tabs_of(const ini::IniFile &ini, diagnostics::Sink &sink);

/// Commands of tabs that are programs with their own windows. Removes the id of an X window ({XID}), because
/// a browser has none.
std::vector<std::string> tab_programs(const std::vector<screen::Tab> &tabs);

/// Commands to be run after the screen's pins exist, in order: halcmd with each [HAL]POSTGUI_HALFILE, haltcl
/// for Tcl files, then each [HAL]POSTGUI_HALCMD.
std::vector<std::vector<std::string>> postgui_commands(const ini::IniFile &ini, const std::string &programs);

/// Runs the commands one after the other and waits for each; failures become messages for the operator.
/// Continues after errors.
std::vector<std::string> run_postgui(const std::vector<std::vector<std::string>> &commands,
                                     const std::string &folder);

}  // namespace mw::programs

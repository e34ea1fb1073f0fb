// SPDX-License-Identifier: GPL-2.0-or-later
// The user panels of [DISPLAY]EMBED_TAB_..., and their programs.
#pragma once

#include <string>
#include <vector>

#include "base/diagnostics/sink.hh"
#include "base/ini/ini_file.hh"
#include "clients/screen/facts/machine_facts.hh"

namespace mw::screen {

/// The tabs in order. A tab without a command, or whose file cannot be read, is reported to `sink` as an
/// error and omitted.
std::vector<Tab> tabs_of(const ini::IniFile &ini, diagnostics::Sink &sink);

/// Commands of tabs that are programs with their own windows. Removes the id of an X window ({XID}), because
/// a browser has none.
std::vector<std::string> tab_programs(const std::vector<Tab> &tabs);

}  // namespace mw::screen

// SPDX-License-Identifier: GPL-2.0-or-later
// Files, folders and programs that an INI file names.
#pragma once

#include "base/diagnostics/sink.hh"
#include "base/ini/ini_file.hh"
#include "machine/config/machine_config.hh"

namespace mw::doctor {

/// Reading the configuration reports HAL files of [HAL]HALFILE and the tool table.
void examine_named_files(const ini::IniFile &ini, const machine::MachineConfig &machine,
                         diagnostics::Sink &sink);

}  // namespace mw::doctor

// SPDX-License-Identifier: GPL-2.0-or-later
// Files, folders and programs that an INI file names.
#pragma once

#include "config/ini_file.hh"
#include "diag/sink.hh"
#include "machine/machine_config.hh"

namespace mw::doctor {

/// HAL files of [HAL]HALFILE and the tool table are read by whoever makes the machine, and told there.
void examine_named_files(const config::IniFile &ini, const machine::MachineConfig &machine, diag::Sink &sink);

}  // namespace mw::doctor

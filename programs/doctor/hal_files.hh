// SPDX-License-Identifier: GPL-2.0-or-later
// Runs the HAL files of a machine without a machine.
#pragma once

#include "base/diagnostics/sink.hh"
#include "base/ini/ini_file.hh"

namespace mw::doctor {

/// Runs the HAL files in this process under the virtual clock, without the programs of loadusr, whose pins
/// are replaced. Continues after errors. Also reports unknown keys, because keys that a HAL file uses are
/// known. The configuration must be without errors.
void examine_hal_files(ini::IniFile ini, diagnostics::Sink &sink);

}  // namespace mw::doctor

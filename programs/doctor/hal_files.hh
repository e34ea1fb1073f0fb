// SPDX-License-Identifier: GPL-2.0-or-later
// The HAL files of a machine, carried out without a machine.
#pragma once

#include "base/diagnostics/sink.hh"
#include "base/ini/ini_file.hh"

namespace mw::doctor {

/// In this process under the virtual clock; programs of loadusr are left out, their pins stand in. Goes on
/// after errors. Also tells unknown keys, as a key that a HAL file uses is none. The configuration must be
/// without errors.
void examine_hal_files(ini::IniFile ini, diagnostics::Sink &sink);

}  // namespace mw::doctor

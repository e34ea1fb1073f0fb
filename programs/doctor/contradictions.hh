// SPDX-License-Identifier: GPL-2.0-or-later
// Settings that are valid alone but contradict each other.
#pragma once

#include "base/diagnostics/sink.hh"
#include "base/ini/ini_file.hh"
#include "machine/config/machine_config.hh"

namespace mw::doctor {

/// Limits of joints and axes, homing, spindles, periods, units, numbers of joints and axes.
void examine_contradictions(const ini::IniFile &ini, const machine::MachineConfig &machine,
                            diagnostics::Sink &sink);

}  // namespace mw::doctor

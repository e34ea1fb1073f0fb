// SPDX-License-Identifier: GPL-2.0-or-later
// Settings of which each is good by itself and that cannot go together.
#pragma once

#include "config/ini_file.hh"
#include "diag/sink.hh"
#include "machine/machine_config.hh"

namespace mw::doctor {

/// Limits of joints and axes, homing, spindles, periods, units, numbers of joints and axes.
void examine_contradictions(const config::IniFile &ini, const machine::MachineConfig &machine,
                            diag::Sink &sink);

}  // namespace mw::doctor

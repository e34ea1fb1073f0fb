// SPDX-License-Identifier: GPL-2.0-or-later
// The environment variables for the programs that the launcher starts.
#pragma once

#include "programs/start/machine_start.hh"

namespace mw::programs {

/// For this process and its children. Call it before the first thread starts.
void set_launch_environment(const machine::LoadedConfig &loaded, const StartSettings &settings);

}  // namespace mw::programs

// SPDX-License-Identifier: GPL-2.0-or-later
// What the programs that the launcher starts look for in their environment.
#pragma once

#include "programs/start/machine_start.hh"

namespace mw::programs {

/// Of this process and all that it starts. Before the first thread.
void set_launch_environment(const machine::LoadedConfig &loaded, const StartSettings &settings);

}  // namespace mw::programs

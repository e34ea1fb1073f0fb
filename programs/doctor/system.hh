// SPDX-License-Identifier: GPL-2.0-or-later
// Checks kernel, processors and rights of the computer for a machine.
#pragma once

#include <string>

#include "base/diagnostics/sink.hh"

namespace mw::doctor {

/// All findings are warnings or notes, because a simulated machine needs none of these properties.
/// @param root  prefix of /sys and /proc, for tests
/// @param realtime_program  the program that needs rights for realtime
void examine_system(const std::string &root, const std::string &realtime_program, diagnostics::Sink &sink);

}  // namespace mw::doctor

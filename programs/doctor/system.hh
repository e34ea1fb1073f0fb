// SPDX-License-Identifier: GPL-2.0-or-later
// Kernel, processors and rights of the computer that is to run a machine.
#pragma once

#include <string>

#include "base/diagnostics/sink.hh"

namespace mw::doctor {

/// All findings are warnings or notes: a simulated machine needs none of it.
/// @param root  in front of /sys and /proc, for tests
/// @param realtime_program  the program that needs rights for realtime
void examine_system(const std::string &root, const std::string &realtime_program, diagnostics::Sink &sink);

}  // namespace mw::doctor

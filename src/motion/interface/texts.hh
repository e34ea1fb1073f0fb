// SPDX-License-Identifier: GPL-2.0-or-later
// Texts for the operator when a command is rejected or a fault occurs. Not realtime.
#pragma once

#include <string>

#include "motion/interface/status.hh"

namespace mw::motion {

/// Reason for rejecting a command, as a sentence with the remedy. Empty for Reason::NONE.
std::string reason_text(const Answer &answer);

/// Text of a fault. Texts that LinuxCNC's screens search for are kept ("joint 0 on limit switch error").
std::string fault_text(const Fault &fault);

}  // namespace mw::motion

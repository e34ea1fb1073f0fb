// SPDX-License-Identifier: GPL-2.0-or-later
// What the operator reads when a command is refused or something goes wrong. Not realtime.
#pragma once

#include <string>

#include "motion/interface/status.hh"

namespace mw::motion {

/// Why a command was refused, as a sentence with what to do about it. Empty for Reason::NONE.
std::string reason_text(const Answer &answer);

/// What went wrong. Texts that existing screens look for are kept ("joint 0 on limit switch error").
std::string fault_text(const Fault &fault);

}  // namespace mw::motion

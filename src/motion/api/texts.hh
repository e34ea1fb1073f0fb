// SPDX-License-Identifier: GPL-2.0-or-later
// Operator's texts for refusals and faults. Not realtime: the servo thread only sends numbers.
#pragma once

#include <string>

#include "motion/api/status.hh"

namespace mw::motion {

/// Why a command was refused, and what to do about it.
std::string reason_text(const Answer &answer);
/// What went wrong by itself.
std::string fault_text(const Fault &fault);

}  // namespace mw::motion

// SPDX-License-Identifier: GPL-2.0-or-later
// Jogs in a servo cycle: leases, jog inhibits, hand wheels, and the conditions of a jog.
#pragma once

#include "motion/servo/parts.hh"

namespace mw::motion {

/// Conditions and limits of a jog of `target`. They have no meaning for a target that does not exist, which
/// is rejected.
JogSituation jog_situation(const ControllerParts &parts, const Inputs &in, const JogTarget &target) noexcept;
/// Called after a change of the limits: keeps jogs within their range.
[[gnu::cold]] void keep_jogs_within_limits(ControllerParts &parts) noexcept;
/// One cycle while the machine is on, before the joints are commanded.
[[gnu::hot]] void step_jogs(ControllerParts &parts, const Inputs &in) noexcept;

}  // namespace mw::motion

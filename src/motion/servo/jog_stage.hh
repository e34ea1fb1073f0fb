// SPDX-License-Identifier: GPL-2.0-or-later
// Jogs in a servo cycle: leases, jog inhibits and hand wheels; and what a jog must know of the machine.
#pragma once

#include "motion/servo/parts.hh"

namespace mw::motion {

/// Conditions and limits of a jog of `target`; without such a target they have no meaning, and it is
/// rejected.
JogSituation jog_situation(const ControllerParts &parts, const Inputs &in, const JogTarget &target) noexcept;
/// After a change of the limits: jogs stay within their range.
[[gnu::cold]] void keep_jogs_within_limits(ControllerParts &parts) noexcept;
/// One cycle while the machine is on, before the joints are commanded.
[[gnu::hot]] void step_jogs(ControllerParts &parts, const Inputs &in) noexcept;

}  // namespace mw::motion

// SPDX-License-Identifier: GPL-2.0-or-later
// Ends a probing move where the probe trips; in any other move a trip is a fault.
#pragma once

#include "motion/servo/parts.hh"

namespace mw::motion {

/// Once per cycle while the machine is on, before the joints are commanded.
[[gnu::hot]] void check_probe(ControllerParts &parts, const Inputs &in) noexcept;

}  // namespace mw::motion

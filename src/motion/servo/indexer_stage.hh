// SPDX-License-Identifier: GPL-2.0-or-later
// Locking indexers in a servo cycle: a jog or move of an indexer waits for its lock.
#pragma once

#include "motion/servo/parts.hh"

namespace mw::motion {

/// One cycle while the machine is on, before the joints are commanded.
[[gnu::cold]] void step_indexers(ControllerParts &parts, const Inputs &in) noexcept;

}  // namespace mw::motion

// SPDX-License-Identifier: GPL-2.0-or-later
// First stage of a servo cycle: measures positions of joints, pose and spindles.
#pragma once

#include <cstdint>

#include "motion/servo/parts.hh"

namespace mw::motion {

/// Returns a bit per spindle whose feedback is not a number.
[[gnu::hot]] std::uint32_t read_feedback(ControllerParts &parts, const Inputs &in) noexcept;

}  // namespace mw::motion

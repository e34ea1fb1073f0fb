// SPDX-License-Identifier: GPL-2.0-or-later
// Result of a command to a part of the controller.
#pragma once

#include <cstdint>

#include "motion/interface/status.hh"

namespace mw::motion {

struct CommandResult {
    Reason reason = Reason::NONE;
    std::int16_t index = -1;  ///< joint or axis of the reason, -1: none
};

/// Result of a command to one joint, axis or spindle.
constexpr CommandResult result_of(int index, Reason reason) noexcept {
    return {reason, static_cast<std::int16_t>(index)};
}

}  // namespace mw::motion

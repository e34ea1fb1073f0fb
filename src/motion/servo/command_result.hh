// SPDX-License-Identifier: GPL-2.0-or-later
// What a part says to a command.
#pragma once

#include <cstdint>

#include "motion/interface/status.hh"

namespace mw::motion {

struct CommandResult {
    Reason reason = Reason::NONE;
    std::int16_t index = -1;  ///< the joint or axis meant, -1: none
};

/// Of one joint, axis or spindle, done or refused.
constexpr CommandResult result_of(int index, Reason reason) noexcept {
    return {reason, static_cast<std::int16_t>(index)};
}

}  // namespace mw::motion

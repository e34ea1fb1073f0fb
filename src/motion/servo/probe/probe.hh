// SPDX-License-Identifier: GPL-2.0-or-later
// The probe: ends probing moves where it trips; a contact in any other motion is a fault.
#pragma once

#include <cstdint>

#include "base/geometry/pose.hh"
#include "motion/interface/command.hh"
#include "motion/interface/status.hh"
#include "motion/servo/command_result.hh"
#include "trajectory/path_store.hh"

namespace mw::motion {

struct TouchProbe {
    bool isTripped = false, wasClosed = false;
    trajectory::Sequence move = 0;  ///< move whose start has cleared `isTripped`
    std::uint32_t trips = 0;        ///< counts probing moves that were tripped
    geometry::Pose position;        ///< position at the last contact
};

struct ProbeInputs {
    bool isClosed = false;
    trajectory::Sequence probing_move = 0;  ///< the active probing move, 0: none
    bool isAway = false;                    ///< that move probes for the loss of contact
    bool isMoving = false;                  ///< anything moves, and no stop is active
    bool isDropping = false;                ///< the path brakes and the rest will be dropped
};

enum class ProbeEvent : std::uint8_t {
    NONE,
    FOUND,    ///< the probing move is to end; `position` is the position of the machine
    TOUCHED,  ///< in a move that is no probing move
};
ProbeEvent step(TouchProbe &probe, const ProbeInputs &in, const geometry::Pose &position) noexcept;

CommandResult take(TouchProbe &probe, const ClearProbeFlag &command) noexcept;
void fill(const TouchProbe &probe, bool isClosed, Status &status) noexcept;

}  // namespace mw::motion

// SPDX-License-Identifier: GPL-2.0-or-later
// The probe: ends probing moves where it trips; touched in any other motion it is a fault.
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
    trajectory::Sequence move = 0;  ///< whose start has cleared `isTripped`
    std::uint32_t trips = 0;        ///< counts probing moves that were tripped
    geometry::Pose position;        ///< where it tripped last
};

struct ProbeInputs {
    bool isClosed = false;
    trajectory::Sequence probing_move = 0;  ///< the probing move under way, 0: none
    bool isAway = false;                    ///< that move looks for the loss of contact
    bool isMoving = false;                  ///< anything moves, and no stop is under way
    bool isDropping = false;                ///< the path brakes and what is left will be dropped
};

enum class ProbeEvent : std::uint8_t {
    NONE,
    FOUND,    ///< the probing move is to end; `position` is where the machine is
    TOUCHED,  ///< in a move that does not probe
};
ProbeEvent step(TouchProbe &probe, const ProbeInputs &in, const geometry::Pose &position) noexcept;

CommandResult take(TouchProbe &probe, const ClearProbeFlag &command) noexcept;
void fill(const TouchProbe &probe, bool isClosed, Status &status) noexcept;

}  // namespace mw::motion

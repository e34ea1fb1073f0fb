// SPDX-License-Identifier: GPL-2.0-or-later
// The probe: ends a probing move where it trips; contact during any other motion is a fault.
#pragma once

#include <cstdint>

#include "base/geometry/pose.hh"
#include "motion/interface/command.hh"
#include "motion/interface/status.hh"
#include "motion/servo/command_result.hh"
#include "trajectory/path_store.hh"

namespace mw::motion {

struct ProbeInputs {
    bool isClosed = false;
    trajectory::Sequence probing_move = 0;  ///< the active probing move, 0: none
    bool isAway = false;                    ///< the move probes for loss of contact
    bool isMoving = false;                  ///< something moves, and no stop is active
    bool isDropping = false;                ///< the path brakes, and the rest will be dropped
};

enum class ProbeEvent : std::uint8_t {
    NONE,
    FOUND,    ///< the probing move must end; `position` is the position of the machine
    TOUCHED,  ///< contact in a move that is not a probing move
};

class TouchProbe {
  public:
    /// One cycle while the machine is on. `position`: measured position.
    ProbeEvent step(const ProbeInputs &in, const geometry::Pose &position) noexcept;
    /// Called at the end of each cycle with the probe state in it.
    void end_cycle(bool isClosed) noexcept { was_closed_ = isClosed; }
    CommandResult take(const ClearProbeFlag &command) noexcept;
    void fill(bool isClosed, Status &status) const noexcept;

    bool wasClosed() const noexcept { return was_closed_; }
    /// Counts probing moves that tripped.
    std::uint32_t trips() const noexcept { return trips_; }

  private:
    bool tripped_ = false, was_closed_ = false;
    trajectory::Sequence move_ = 0;  ///< move whose start has cleared `tripped_`
    std::uint32_t trips_ = 0;
    geometry::Pose position_;  ///< at the last contact
};

}  // namespace mw::motion

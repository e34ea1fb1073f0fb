// SPDX-License-Identifier: GPL-2.0-or-later
// Conditions of a path besides its moves: limits, range of the machine, overrides, single block. Values;
// every step of the planner's parts gets them.
#pragma once

#include <array>
#include <cmath>

#include "trajectory/path/move_request.hh"
#include "trajectory/path/path_limits.hh"
#include "trajectory/path/spindle_braking.hh"
#include "trajectory/path/workspace.hh"

namespace mw::trajectory {

class SpeedChooser;

/// What may change while the path is under way.
struct Scales {
    double feed = 1.0;
    double rapid = 1.0;
    double max_velocity = UNLIMITED;  ///< operator's ceiling along the feed length
    std::array<double, MAX_SPINDLES> spindle_rps{};
};

/// Single blocks: stops where the source block is another than `block`.
struct SingleBlocks {
    bool isOn = false;
    std::uint32_t block = 0;
    bool isStopBefore(const MoveTag &tag) const noexcept { return isOn && tag.block != block; }
};

struct Conditions {
    explicit Conditions(double period_s) noexcept : limits(period_s) {}

    PathLimits limits;
    Workspace workspace;
    Scales scales;
    SingleBlocks blocks;
    std::array<SpindleBrakings, MAX_SPINDLES> brakings{};
    std::array<double, MAX_SPINDLES> encoder_steps{};  ///< [rev]
    SpeedChooser *chooser = nullptr;                   ///< null: as fast as all that holds allows

    /// Driven by the executor, locked to the angle of a spindle. Machines whose joints are not axes drive
    /// threads by time, but not taps.
    bool isLocked(const MoveRequest &request) const noexcept {
        return request.isLocked && (request.isTapped || !workspace.isMapped());
    }
};

/// Speed of a move that follows a spindle, at the spindle's present speed, along the parameter.
inline double turning_speed(const MoveRequest &move, const Scales &scales) noexcept {
    const double rps = std::abs(scales.spindle_rps[static_cast<std::size_t>(move.spindle)]);
    return move.feed_per_revolution * move.tag.feed_ratio * rps;
}

}  // namespace mw::trajectory

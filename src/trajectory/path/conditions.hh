// SPDX-License-Identifier: GPL-2.0-or-later
// Conditions of a path in addition to its moves: limits, workspace, overrides, single block. The parts of the
// planner receive them as values in every step.
#pragma once

#include <array>
#include <cmath>

#include "trajectory/path/move_request.hh"
#include "trajectory/path/path_limits.hh"
#include "trajectory/path/spindle_braking.hh"
#include "trajectory/path/workspace.hh"

namespace mw::trajectory {

class SpeedChooser;

/// Overrides and spindle speeds, which may change during the path.
struct Scales {
    double feed = 1.0;
    double rapid = 1.0;
    double max_velocity = UNLIMITED;  ///< maximum velocity of the operator, along the feed length [unit/s]
    std::array<double, MAX_SPINDLES> spindle_rps{};
};

/// Single block: the path stops before moves of any block other than `block`.
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
    std::array<double, MAX_SPINDLES> encoder_steps{};  ///< resolution of the encoder [rev]
    SpeedChooser *chooser = nullptr;                   ///< null: no planner module

    /// True if the executor locks the move to the angle of a spindle. On machines whose joints are not axes,
    /// threads are time-driven; taps are locked.
    bool isLocked(const MoveRequest &request) const noexcept {
        return request.isLocked && (request.isTapped || !workspace.isMapped());
    }
};

/// Speed along the parameter of a move with feed per revolution, at the current spindle speed.
inline double turning_speed(const MoveRequest &move, const Scales &scales) noexcept {
    const double rps = std::abs(scales.spindle_rps[static_cast<std::size_t>(move.spindle)]);
    return move.feed_per_revolution * move.tag.feed_ratio * rps;
}

}  // namespace mw::trajectory

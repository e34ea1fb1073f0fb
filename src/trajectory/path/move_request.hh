// SPDX-License-Identifier: GPL-2.0-or-later
// Parameters of a move in addition to its geometry.
#pragma once

#include "base/geometry/move_settings.hh"
#include "trajectory/path_store.hh"

namespace mw::trajectory {

struct MoveRequest {
    MoveTag tag;
    geometry::PathMode join = geometry::PathMode::BLEND;
    /// Tolerance P of the path [machine units; degrees for moves of A B C only]. 0: no tolerance programmed
    /// (PathLimits::free_tolerance).
    double tolerance = 0;
    double corner_scale = 1;  ///< part of the possible speed on curves (G64 R)
    bool isRapid = false;     ///< rapid move: its speed is scaled by Scales::rapid
    bool isOverridable = true;
    /// The feed length is over A B C; the operator's maximum velocity does not apply.
    bool isAngular = false;
    double feed_per_revolution = 0;  ///< above 0: the speed follows a spindle [unit/rev]
    int spindle = 0;
    bool isSynched() const noexcept { return feed_per_revolution > 0; }
    bool isLocked = false;  ///< locked to the spindle angle: a thread
    bool isGated = false;   ///< the path stops before this move until the gate opens
    bool isPhased = false;  ///< the start is delayed to a full revolution of the spindle
    /// Rigid tap: this move is the cut, locked to the spindle angle. The next move is the retract, back to
    /// its start.
    bool isTap = false;
    bool isTapped = false;  ///< this move is the cut or the retract of a tap
    double tap_scale = 1;   ///< spindle speed of the retract divided by that of the cut
    /// Clearance of the line before its start and after its end [unit].
    double room_before = 0, room_behind = 0;
};

/// True if the motion must stop between `a` and `b` in any path mode: at a gate, before and after a probing
/// move, and between moves with and without feed per revolution.
inline bool isStopBetween(const MoveRequest &a, const MoveRequest &b) noexcept {
    return b.isGated || a.tag.isProbe || b.tag.isProbe || a.isSynched() != b.isSynched();
}

}  // namespace mw::trajectory

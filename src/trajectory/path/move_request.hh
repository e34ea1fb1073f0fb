// SPDX-License-Identifier: GPL-2.0-or-later
// One move of a path besides its geometry.
#pragma once

#include "base/geometry/move_settings.hh"
#include "trajectory/path_store.hh"

namespace mw::trajectory {

struct MoveRequest {
    MoveTag tag;
    geometry::PathMode join = geometry::PathMode::BLEND;
    /// Of a blend [machine units; degrees over ABC]; 0: as the speed needs, in proportion to the move.
    double tolerance = 0;
    double corner_scale = 1;  ///< part of the reachable speed on curves (G64 R)
    bool isRapid = false;     ///< as fast as the limits allow, scaled by Scales::rapid
    bool isOverridable = true;
    bool isAngular = false;  ///< the feed length is over ABC: the operator's velocity ceiling does not apply
    double feed_per_revolution = 0;  ///< > 0: the speed follows a spindle
    int spindle = 0;
    bool isSynched() const noexcept { return feed_per_revolution > 0; }
    bool isLocked = false;  ///< keeps to the angle of the spindle: a thread
    bool isGated = false;   ///< a stop before it until the gate opens
    bool isPhased = false;  ///< the gate opens at a spindle phase
    /// In to the end of this move with the spindle's angle, and out again along the next one, which is the
    /// way back to its start.
    bool isTap = false;
    bool isTapped = false;                    ///< this move, or the retract
    double tap_scale = 1;                     ///< spindle speed of the retract over that of the cut
    double room_before = 0, room_behind = 0;  ///< clearance of the line before its start and after its end
};

/// In any path mode: the motion stops at a gate, and probing moves, and feeds per revolution beside others,
/// begin and end at the programmed place.
inline bool isStopBetween(const MoveRequest &a, const MoveRequest &b) noexcept {
    return b.isGated || a.tag.isProbe || b.tag.isProbe || a.isSynched() != b.isSynched();
}

}  // namespace mw::trajectory

// SPDX-License-Identifier: GPL-2.0-or-later
// What a program settles for a move, in the one form that interpreter, task, motion and planner share.
#pragma once

#include <cstdint>

namespace mw::geometry {

/// How a move passes into the next: G61.1, G61, G64 (RS-274/NGC, "Set Path Control Mode").
enum class PathMode : std::uint8_t {
    EXACT_STOP,  ///< comes to a stop at the end of the move
    EXACT_PATH,  ///< passes the end without a stop only where the path goes on in the same direction
    BLEND,       ///< rounds the corner within the tolerance
};

/// Settings in force for a move. Speeds are along the programmed feed length (XYZ if it moves, else UVW, else
/// ABC).
struct MoveSettings {
    bool isRapid = false;  ///< G0: as fast as the limits allow
    PathMode mode = PathMode::BLEND;
    std::int8_t synch_spindle = 0;
    bool isVelocitySynched = false;  ///< feed follows the spindle's speed, not its angle
    /// [machine units/s, or degrees/s for moves of ABC alone]; 0: as fast as the limits allow. Inverse time
    /// (G93) is already turned into the speed of this move.
    double feed = 0;
    double tolerance = 0;  ///< G64 P [machine units; the same figure in degrees for ABC]; 0: no bound
    double naivecam_tolerance = 0;   ///< G64 Q [machine units]
    double corner_scale = 0;         ///< G64 R: part of the reachable corner speed; 0: as the machine is set
    double feed_per_revolution = 0;  ///< > 0: follows `synch_spindle` [machine units]

    /// The tool keeps to the spindle's angle, not only to its speed.
    bool isThread() const noexcept { return feed_per_revolution > 0 && !isVelocitySynched; }
    bool operator==(const MoveSettings &) const = default;
};

}  // namespace mw::geometry

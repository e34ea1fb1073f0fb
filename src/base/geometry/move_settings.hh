// SPDX-License-Identifier: GPL-2.0-or-later
// Settings that a program selects for a move, in the form that interpreter, task, motion and planner share.
#pragma once

#include <cstdint>

namespace mw::geometry {

/// Path control mode at the end of a move: G61.1, G61, G64 (RS-274/NGC, "Set Path Control Mode").
enum class PathMode : std::uint8_t {
    EXACT_STOP,  ///< stops at the end of the move
    EXACT_PATH,  ///< passes the end without a stop only if the path continues in the same direction
    BLEND,       ///< rounds the corner within the tolerance
};

/// Settings of a move. Speeds are along the programmed feed length (XYZ if it moves, else UVW, else ABC).
struct MoveSettings {
    bool isRapid = false;  ///< G0: maximum speed within the limits
    PathMode mode = PathMode::BLEND;
    std::int8_t synch_spindle = 0;
    bool velocity_synched = false;  ///< feed follows the spindle speed, not its angle
    /// [machine units/s, or degrees/s for moves of ABC alone]; 0: maximum speed within the limits. Inverse
    /// time feed (G93) is already converted to the speed of this move.
    double feed = 0;
    double tolerance = 0;  ///< G64 P [machine units; for ABC the same number in degrees]; 0: no tolerance
    double naivecam_tolerance = 0;  ///< G64 Q [machine units]
    double corner_scale = 0;  ///< G64 R: fraction of the reachable corner speed; 0: setting of the machine
    double feed_per_revolution = 0;  ///< > 0: follows `synch_spindle` [machine units]

    /// The tool follows the spindle angle, not only the spindle speed.
    bool isThread() const noexcept { return feed_per_revolution > 0 && !velocity_synched; }
    bool operator==(const MoveSettings &) const = default;
};

}  // namespace mw::geometry

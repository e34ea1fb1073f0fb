// SPDX-License-Identifier: GPL-2.0-or-later
// Constants of rigid tapping, with their reasons.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace mw::trajectory {

/// Constants of the joints along the line of a tap (line_joints).
struct LineJointTuning {
    /// Number of samples along the line, and distance of the samples for derivatives [unit]. Third
    /// differences of joints at 1000 mm are then exact to 1e-7, and no machine has details as small as this
    /// distance.
    static constexpr int PLACES = 33;
    static constexpr double STEP = 0.02;
    /// Relative error of a joint position by rounding or by an iterative inverse.
    static constexpr double ROUNDING = 1e-12;
    /// Factor that makes bounds of the derivatives from their differences.
    static constexpr double MARGIN = 1.01;
    /// Part of acceleration and jerk that the curvature of the joint paths may use at maximum speed. The tool
    /// needs the rest to follow the spindle.
    static constexpr double TURNING = 0.5;
    /// Part of the remaining jerk for the term 3 q'' x' x'', the change of direction during a change of
    /// speed.
    static constexpr double CROSS_SHARE = 0.5;
    /// Factor of the limits that leaves a margin for rounding.
    static constexpr double FULL = 0.9999;
};

/// Constants of rigid tapping.
struct TapTuning {
    /// The tool is on the helix if its error is below MET [rev] or MET_STEPS encoder steps. With an error of
    /// LOST (a quarter of a revolution) the tap fails.
    static constexpr double MET = 1e-3, MET_STEPS = 2, LOST = 0.25;
    /// With jerk limits, a tap whose error would exceed MOST_OFF [rev] while the spindle reverses is
    /// rejected. A change of the spindle acceleration is followed with a delay. Its square, halved, is LATE /
    /// rate^2 + LATE_CYCLES * period^2 (measured values, with the rate of the measurement). After a change,
    /// the tool is on the helix again within SETTLING times A/J.
    static constexpr double MOST_OFF = 0.1, LATE = 4, LATE_CYCLES = 10, SETTLING = 2;
    /// Distance between tool and thread before the spindle runs forward again [rev].
    static constexpr double CLEARANCE = 0.5;
    /// MORE_ROOM: clearance below the bottom in addition to the known overrun of the spindle. LEAST_ROOM:
    /// minimum clearance before the start and below the bottom [rev].
    static constexpr double MORE_ROOM = 2, LEAST_ROOM = 1;
    /// For joints that are not axes. The spindle may run faster than its current speed by the factor
    /// OVERSPEED. The tool may be faster up to the joint limits, as long as the curvature of the joint paths
    /// leaves SPEED_WORTH of the acceleration. SPEED_STEPS speeds are tried.
    static constexpr double OVERSPEED = 1.1, SPEED_WORTH = 0.9;
    static constexpr int SPEED_STEPS = 8;
    /// Maximum clearance that is searched past both ends of the line [rev]. The samples for derivatives stay
    /// within it by ROOM_MARGIN [unit].
    static constexpr double MOST_ROOM = 25, ROOM_MARGIN = 3 * LineJointTuning::STEP;
    /// After a stop, the tool follows the spindle while it runs down: for RUN_OUT times its known overrun
    /// plus one revolution, or for UNKNOWN_RUN_OUT revolutions if the overrun is not known. Below STANDING
    /// [rev/s] the spindle is stopped.
    static constexpr double RUN_OUT = 1.5, UNKNOWN_RUN_OUT = 5, STANDING = 0.02;
};

}  // namespace mw::trajectory

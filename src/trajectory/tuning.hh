// SPDX-License-Identifier: GPL-2.0-or-later
// Figures of rigid tapping that were chosen, with their reasons.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace mw::trajectory {

/// Joints along the line of a tap (line_joints).
struct LineJointTuning {
    /// Samples along the line, and the distance for derivatives there: third differences of 1000 mm are then
    /// exact to 1e-7, and no machine's curves are as narrow.
    static constexpr int PLACES = 33;
    static constexpr double STEP = 0.02;
    /// What rounding, or an inverse that iterates, makes of a joint's place, relative to it.
    static constexpr double ROUNDING = 1e-12;
    /// Ratio of derivatives to their differences.
    static constexpr double MARGIN = 1.01;
    /// Part of acceleration and jerk that the curves of joints may take at maximum speed: the rest is for
    /// following the spindle.
    static constexpr double TURNING = 0.5;
    /// Part of the jerk that is left for the change of direction while the speed changes.
    static constexpr double CROSS_SHARE = 0.5;
    /// Kept off the limits by what sums of rounding make.
    static constexpr double FULL = 0.9999;
};

/// Rigid tapping.
struct TapTuning {
    /// The helix counts as met within this part of a revolution, or so many steps of the encoder. At LOST, a
    /// quarter of a revolution, the tap is lost.
    static constexpr double MET = 1e-3, MET_STEPS = 2, LOST = 0.25;
    /// With jerk limits: a tap that would leave the helix by more while its spindle reverses is rejected
    /// [rev]. The change is seen late: LATE over the square of the rate of the measurement, and LATE_CYCLES
    /// squared servo periods. Measured. After a change the tool is on the helix again within so many times of
    /// A/J.
    static constexpr double MOST_OFF = 0.1, LATE = 4, LATE_CYCLES = 10, SETTLING = 2;
    /// The tool leaves the thread by this much before the spindle runs forward again [rev].
    static constexpr double CLEARANCE = 0.5;
    /// Clearance of the tool below the bottom in addition to the known overrun of the spindle, and minimum
    /// clearance before the start and below the bottom [rev].
    static constexpr double MORE_ROOM = 2, LEAST_ROOM = 1;
    /// Where joints are not axes: the spindle may run faster than now by this factor. The tool may be faster
    /// still, up to the limits of the joints, as long as their curves leave this part of the acceleration;
    /// number of speeds that are tried.
    static constexpr double OVERSPEED = 1.1, SPEED_WORTH = 0.9;
    static constexpr int SPEED_STEPS = 8;
    /// Maximum clearance that is searched past both ends of the line [rev]; the samples for derivatives stay
    /// within it [machine units].
    static constexpr double MOST_ROOM = 25, ROOM_MARGIN = 3 * LineJointTuning::STEP;
    /// After a stop the tool follows the spindle while it runs down, for this many times its known run-out
    /// and one revolution; for the second value if nothing is known. Below the third speed the spindle is
    /// stopped [rev/s].
    static constexpr double RUN_OUT = 1.5, UNKNOWN_RUN_OUT = 5, STANDING = 0.02;
};

}  // namespace mw::trajectory

// SPDX-License-Identifier: GPL-2.0-or-later
// Every figure of the planner and executor that was chosen, by the part that uses it, with its reason. Where
// the reason is a measurement, docs/developer/planner.md ("Figures") has the cost of other values.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace mw::trajectory {

/// What lines join, where a path stops, how it is cut into pieces.
struct PathTuning {
    /// Tangents that differ by less are equal except for rounding: the step of speed is below any limit.
    static constexpr double SAME_DIRECTION = 1e-11;
    /// Exact path: a smaller change of the tangent is rounding of the program's numbers and no corner.
    /// Coordinates rounded to 0.001 change the tangent of lines of 0.1 by up to 0.02.
    static constexpr double EXACT_STEP = 0.02;
    /// Exact path: the deviation with which such a corner is passed [machine units].
    static constexpr double EXACT_DEVIATION = 1e-6;
    /// A path that turns back by more than this (cosine; 154 deg) is a reversal: the end of the move is what
    /// matters, and a blend would cut it off by half its d.
    static constexpr double REVERSAL_COSINE = -0.9;
    /// Below this a blend is a stop: passing it takes less than a sample from 1 unit/s^2 on.
    static constexpr double SMALLEST_BLEND = 1e-7;
    /// A part of a move shorter than this of it is none: rounding.
    static constexpr double SMALLEST_PART = 1e-12;
    /// Moves passed in one servo cycle at most; with all their pieces and up to four phases a piece, 12 * 70
    /// * 4 = 3360, this stays below Executor::MAX_STEPS_PER_CYCLE = 4096.
    static constexpr double MOVES_PER_CYCLE = 12;
    /// Arcs are cut so that the direction of the path, and with it the share of each axis, changes by an
    /// eighth at most on each piece; where the feed is what binds, half a radian will do [rad]. Measured.
    static constexpr double ARC_CUT = 0.13;
    static constexpr double ARC_CUT_WHEN_SLOW = 0.5;
    static constexpr int MOST_ARC_CUTS = 64;
    /// Blends as well, in four pieces at most [rad].
    static constexpr double BLEND_CUT = 0.3;
    static constexpr int MOST_BLEND_CUTS = 4;
    /// Lines are cut so that joints that are not axes change their slope little: by 1.7 % a degree of
    /// rotation. At least four cuts, as joints may turn back on the way [deg].
    static constexpr double JOINT_CUT_DEG = 1.0;
    static constexpr double LEAST_JOINT_CUTS = 4;
    /// Part of the tolerance that joining lines may take when no other tolerance is given for it (corners
    /// need the rest), and at most (what joining takes, corners lose: half each).
    static constexpr double JOIN_SHARE = 0.1, MOST_JOIN_SHARE = 0.5;
    /// Lines that one line may replace: each new one checks all ends again, so this bounds the work of a
    /// block.
    static constexpr std::size_t MOST_JOINED = 64;
    /// Deviation of the curve without a programmed tolerance: part of a line's length, of an arc's
    /// radius, and at least the distance in this time at maximum speed.
    static constexpr double FREE_OF_LENGTH = 0.1, FREE_OF_RADIUS = 1e-3, NOMINAL_S = 1e-4;
};

/// Speeds and accelerations of a stretch (limits.cc).
struct LimitTuning {
    /// Centripetal share of an axis's acceleration on a blend that is made for a given speed: at 0.7 as much
    /// (sqrt(1 - 0.7^2) = 0.71 of a norm) is left for braking on it.
    static constexpr double BLEND_SHARE = 0.7;
    /// Margin that keeps fitted stops (Executor) and rounding inside the limits.
    static constexpr double ACCELERATION_MARGIN = 1e-6;
    /// Parts of the maximum squared speed between which the remaining acceleration is a chord: denser where a
    /// concave bound falls fastest.
    static constexpr double CHORDS[] = {0, 0.5, 0.85, 1};
};

/// Stops on curves (braking_on).
struct BrakingTuning {
    /// Where maximum speed on a curve leaves this part of the acceleration, a stop by the sum is fast enough:
    /// the slower, the more is left.
    static constexpr double ENOUGH = 0.5;
    /// An arc that turns by more than this has parts where other axes, or joints, move [rad].
    static constexpr double SWEEP = 0.2;
    /// A piece that takes no longer at its maximum speed delays no stop [s]. This makes planning of dense
    /// programs twice as fast.
    static constexpr double SHORT_S = 0.002;
    /// As the speed falls, a curve leaves more acceleration: it is evaluated again where the squared speed
    /// has fallen to a part, if that gives this many times as much, and at least SHORT_S later. The nearer
    /// the centripetal acceleration is to the limit, the more an early evaluation gains.
    struct Look {
        double slower, gain;
    };
    static constexpr Look LOOKS[] = {{0.97, 1.5}, {0.9, 1.3}, {0.7, 1.05}};
    /// On a circle, u of the maximum squared speed leaves the root of 1 - u^2, of which a chord of the
    /// planned bound is a small part near 1: a path at the limit could not brake from there. A separate bound
    /// has these parts and is evaluated as often.
    static constexpr double CHORDS[] = {0, 0.5, 0.85, 0.97, 0.995, 0.9995, 1};
    static constexpr Look DENSE_LOOKS[] = {{0.9995, 1.5}, {0.998, 1.3}, {0.99, 1.3},
                                           {0.97, 1.5},   {0.9, 1.3},   {0.7, 1.05}};
    /// Part of the maximum speed at which such curves are driven, so that braking can begin.
    static constexpr double DENSE_DRIVEN = 1 - 5e-5;
    /// Ratio of derivatives to their differences.
    static constexpr double MARGIN = 1.002;
    /// A separate bound has to be better by this factor somewhere.
    static constexpr double LEAST_GAIN = 1.05;
    /// Parts next to each other whose bounds differ by less have the lesser in common: fewer legs of a stop.
    static constexpr double LIKE = 1.2;
};

/// Limits of joints that are not axes (joint_rows).
struct JointTuning {
    /// The derivatives are sampled at three places; between them they may be larger by this much. The trial
    /// judges what this misses.
    static constexpr double SAMPLING_MARGIN = 1.02;
    static constexpr int SAMPLES = 3;
    /// Path over which derivatives are taken: small against curves of machines, large against rounding
    /// (second differences of 1000 mm are then exact to 1e-6).
    static constexpr double STEP = 1e-3;
    /// Of a second difference by rounding, relative to the step's own size.
    static constexpr double JITTER = 1e-6;
};

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

/// Profiles, and when a plan is made.
struct TimingTuning {
    /// Braking that misses a stop at a piece's end by rounding alone is fitted to it; piece accelerations
    /// keep LimitTuning::ACCELERATION_MARGIN, ten times this.
    static constexpr double STOP_FIT = 1e-7;
    /// Speeds that differ by this part are the same.
    static constexpr double SAME_SPEED = 1e-9;
    /// A speed below this part of what one sample's acceleration gives is rounding.
    static constexpr double STANDING = 1e-13;
    /// A stopped path at most this far from the end of a piece is at the end [machine units].
    static constexpr double AT_END = 2e-12;
    /// A rise is made when it gains this part of the speed, or this part where it does not reach the cap.
    static constexpr double RISE_WORTH = 1e-6, PART_RISE_WORTH = 1e-3;
    static constexpr int RISE_STEPS = 40;       ///< of bisection
    static constexpr double ROUND_END = 1e-12;  ///< part of a piece within which its end is reached
    /// A coast takes at least this part of what is left of a piece: no phase without a way.
    static constexpr double LEAST_COAST = 1e-9;
    /// Phases of a piece with acceleration limits: one that comes down to an override, up, level, down.
    static constexpr std::uint64_t PHASES_PER_PIECE = 4;
    static constexpr std::uint64_t PHASES_PER_STOP = 8;
    /// A plan is renewed when less than this part of the horizon is left.
    static constexpr double RENEWAL = 0.6;
    /// Attempts at a plan before the previous one stays active.
    static constexpr int ATTEMPTS = 24;
    /// The same at standstill, when all plans were rejected: there is no active plan then.
    static constexpr int ATTEMPTS_AT_REST = 96;
    /// Planner periods at standstill without a plan, a second of them, before a fault is reported.
    static constexpr int MOST_REFUSALS = 200;
    /// Spindles never keep their speed: what changes by more than the first part is followed at once, by more
    /// than the second once in so many updates, so that a lead does not drift.
    static constexpr double CHANGED = 1e-3, DRIFTED = 1e-7;
    static constexpr int STEADY_UPDATES = 4;
};

/// The trial of a plan.
struct TrialTuning {
    /// Samples that are tried; the rest of a longer stop is braking alone.
    static constexpr std::uint64_t MOST_SAMPLES = 4000;
    /// Phases in one sample; the executor passes twice as many at most.
    static constexpr std::uint64_t MOST_PHASES = 2000;
    /// Relative margin of a speed that is kept: rounding.
    static constexpr double ROUNDING = 1e-7;
    /// Relative slack of what the trial compares, half of what checkers of the trajectory allow.
    static constexpr double SLACK = 1.0 + 5e-7;
};

/// Slowing down pieces that a trial has rejected.
struct EasingTuning {
    /// What one attempt leaves of speed and acceleration: the joints exceed a limit by a part that is not
    /// measured.
    static constexpr double SLOWER = 0.9, GENTLER = 0.8;
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

/// The servo side.
struct ExecutorTuning {
    /// Distance from the end of a piece that is rounding, at a length of 1.
    static constexpr double ARRIVED = 4e-12;
    /// A speed below this part of what the phase's acceleration makes in its time is a stop.
    static constexpr double STOPPED = 1e-9;
};

}  // namespace mw::trajectory

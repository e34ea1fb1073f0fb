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
    /// Exact path: corners that come from rounding of a program's figures are passed: 0.02 is what figures
    /// rounded to 0.001 do to the tangents of lines of 0.1,
    static constexpr double EXACT_STEP = 0.02;
    /// within a deviation that no machine shows [machine units].
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
    /// A line has a separate part next to a blend if this is at most this share of the line: less than half,
    /// so that both ends may have one and a part is left between them.
    static constexpr double ZONE_SHARE = 0.45;
    /// Part of the tolerance that joining lines may take when no other tolerance is given for it (corners
    /// need the rest), and at most (what joining takes, corners lose: half each).
    static constexpr double JOIN_SHARE = 0.1, MOST_JOIN_SHARE = 0.5;
    /// Lines that one line may replace: each new one checks all ends again, so this bounds the work of a
    /// block.
    static constexpr std::size_t MOST_JOINED = 64;
    /// Deviation of the moving average without a programmed tolerance: part of a line's length, of an arc's
    /// radius, and at least the distance in this time at maximum speed.
    static constexpr double FREE_OF_LENGTH = 0.1, FREE_OF_RADIUS = 1e-3, NOMINAL_S = 1e-4;
    /// Ratio of the averaging time to the best one for a move from which a separate path is worth its stop:
    /// speed on curves goes with 1/tau, so a fifth is lost at most.
    static constexpr double MOST_UNSUITED = 1.25;
    /// A blend is among others where a line beside it is shorter than this many times the distance in the
    /// averaging time: the zones on either side take one each.
    static constexpr double SHARED_REACH = 3.0;
};

/// Speeds and accelerations of a stretch (limits.cc).
struct LimitTuning {
    /// Centripetal share of an axis's acceleration on a blend that is made for a given speed: at 0.7 as much
    /// (sqrt(1 - 0.7^2) = 0.71 of a norm) is left for braking on it.
    static constexpr double BLEND_SHARE = 0.7;
    /// The averaging time is at most this factor longer than the best one on curves: see
    /// docs/developer/planner.md. Measured: 0.96 is 0.8 % slower, 1.5 as fast.
    static constexpr double CURVE_SHARE = 1.2;
    /// Minimum averaging time where rotary axes move with linear ones, as a part of what the rotary axes need
    /// alone: unless a tolerance makes it shorter, their stops take at most twice the time that their limits
    /// need.
    static constexpr double TURNING_SHARE = 0.5;
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
    /// On a circle, u of the maximum squared speed leaves the root of 1 - u^2, of which a chord from CHORDS
    /// is a small part near 1: a path at the limit could not brake from there. Without a moving average,
    /// through which a deceleration takes tau, the bound has these parts and is evaluated as often.
    static constexpr double DENSE_CHORDS[] = {0, 0.5, 0.85, 0.97, 0.995, 0.9995, 1};
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
    /// Of an arc that is one piece: two for what others are cut into.
    static constexpr int MOST_SAMPLES = 2 * PathTuning::MOST_ARC_CUTS + 1;
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

/// Corners and arcs with jerk limits.
struct CornerTuning {
    /// Part of the tolerance that blends may take where corners follow each other closely, and what a slight
    /// turn is spread by. Measured: both are flat.
    static constexpr double GEOMETRY_SHARE = 0.35, SPREAD_SHARE = 0.05;
    /// Part of tau that the faster side of a slight corner may lose on its blend, which is passed at the
    /// speed of the slower side.
    static constexpr double SPREAD_WORTH = 0.1;
    /// Part of the tolerance for the moving average on an arc. Measured: less costs time; 0.96 gains up to
    /// 0.4 % with low jerk limits, nothing with high ones.
    static constexpr double ARC_SHARE = 0.92;
    /// Part of the tolerance that is planned with; the rest is for what the formulas leave out. Measured:
    /// less costs time.
    static constexpr double TOLERANCE_SHARE = 0.95;
    /// Up to this ratio of an acceleration step to what the average can spread, less acceleration costs less
    /// time than a dwell: about 2 tau (1 - 1/r) against tau - dwell. Measured.
    static constexpr double MOST_SWING = 1.7, GENTLE_ROOM = 0.999;
    /// From the width of a blend that takes BLEND_SHARE of the acceleration to one that takes 0.95.
    static constexpr double TURNING_FIT = LimitTuning::BLEND_SHARE / 0.95;
    /// Corners are dense where they are nearer than this part of the distance in the averaging time.
    /// Measured: flat.
    static constexpr double DENSE = 0.7;
    /// Part of the acceleration that is for turning where curves follow each other closely, and the least.
    /// Measured: 0.985 is as fast within 0.1 %, with less left for the path.
    static constexpr double TURNING_SHARE = 0.97, LEAST_TURNING = 0.02;
    /// What the turning of neighbours may be more than a place's own, and how much is left for that.
    /// Measured: 0.88 is 2.8 % slower, 1.375 0.4 %.
    static constexpr double SHARED_TURNS = 1.1, SHARED_REST = 0.985;
    /// A corner is passed where building up its speed and the saved dwell take more than this part of tau.
    /// Measured: flat.
    static constexpr double PASS_WORTH = 0.8;
    /// The path stops at a corner whose speed is reached in this part of tau: the reference would keep such a
    /// speed for tau before and after it. Measured: 0.02 to 0.1 the same.
    static constexpr double CRAWL = 0.05;
    /// Of a whole arc that is followed exactly. Turning is across the path, the rest along it:
    /// 0.6^2 + 0.75^2 < 1 of the acceleration; of the jerk (0.6 + 0.2)^2 + 0.5^2 < 1, 0.6 from the
    /// acceleration built up in tau.
    static constexpr double ALONG_ACCELERATION = 0.6, ALONG_TURNING = 0.75;
    static constexpr double ALONG_JERK = 0.2, ALONG_CROSS_JERK = 0.5;
    /// Of a part of it: all that the axes' directions there leave.
    static constexpr double ALONG_SHARE = 0.98;
    static constexpr int SPEED_STEPS = 50;  ///< of bisection: more than a double has bits
};

/// Corners of dense lines that are moved outwards.
struct ShapeTuning {
    /// A corner of a curve turns by less [rad]. Measured: flat.
    static constexpr double MOST_TURN = 0.4;
    /// Part of the tolerance for the average without moved corners, and the maximum displacement of corners:
    /// at standstill the path is outside by that, at speed inside by up to 0.95, so v may be sqrt(0.95 +
    /// 0.75) = 1.3 times as high. Measured: flat.
    static constexpr double FREE_SHARE = 0.95, MOST_SHARE = 0.75;
    /// Shifts follow the curvature over this part of the distance in the averaging time: a short part
    /// follows, a long one adds less curvature. Measured: flat.
    static constexpr double FOLLOWING = 0.3;
    /// Shifts below this are none [machine units].
    static constexpr double SMALLEST_SHIFT = 1e-9;
};

/// Profiles, and when a plan is made.
struct TimingTuning {
    /// Braking that misses a stop at a piece's end by rounding alone is fitted to it; piece accelerations
    /// keep LimitTuning::ACCELERATION_MARGIN, ten times this.
    static constexpr double STOP_FIT = 1e-7;
    /// Parts of the brake that stops are tried with, and of these the parts with which they begin; below 0
    /// some speed is gained at first.
    static constexpr std::array STOP_SHARES{1.0, 0.8, 0.6, 0.4};
    static constexpr std::array FIRST_SHARES{1.0, 0.7, 0.4, 0.2, 0.0, -0.2};
    /// On exact arcs, which share their acceleration in fixed parts: the trial judges the averaged position
    /// there, and another axis can brake with what one does not use on the curve.
    static constexpr std::array HARDER_SHARES{5.0, 2.5, 1.5};
    /// Speeds that differ by this part are the same.
    static constexpr double SAME_SPEED = 1e-9;
    /// A speed below this part of what one sample's acceleration gives is rounding.
    static constexpr double STANDING = 1e-13;
    /// A stopped path at most this far from the end of a piece is at the end [machine units].
    static constexpr double AT_END = 2e-12;
    /// A rise is made when it gains this part of the speed, or this part where it does not reach the cap.
    static constexpr double RISE_WORTH = 1e-6, PART_RISE_WORTH = 1e-3;
    static constexpr int RISE_STEPS = 40;       ///< of bisection
    static constexpr double SOON = 1e-9;        ///< shorter waits are none [s]
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
    /// Relative margin of an acceleration step, for rounding sums over the averaging time.
    static constexpr double ROUNDING = 1e-7;
    /// Relative slack of what the trial compares, half of what checkers of the trajectory allow.
    static constexpr double SLACK = 1.0 + 5e-7;
    /// Excess of a limit that has no measure: that of the reference itself, or of a joint.
    static constexpr double UNMEASURED = 2;
};

/// Slowing down pieces that a trial has rejected.
struct EasingTuning {
    /// Least and most part of speed and of acceleration that one attempt leaves.
    static constexpr double SLOWEST = 0.9, GENTLEST = 0.8, LEAST_SLOWER = 0.99, LEAST_GENTLER = 0.98;
    /// An excess that less acceleration about a stop may cure.
    static constexpr double MOST_GENTLE = 1.3;
    /// Part of the averaging time by which a dwell becomes longer in one attempt, and the part of a dwell
    /// that reduced acceleration may cost.
    static constexpr double STAND_STEP = 0.2, STAND_WORTH = 0.5;
    /// Less acceleration along the path cures an excess of the acceleration step along it: from this part on,
    /// by how much more than that, and the minimum that is left in all.
    static constexpr double ALONG_SHARE = 0.5, ALONG_MARGIN = 1.1, ALONG_ROOM = 1e-4, LEAST_ALONG = 0.8;
    /// What is left of an excess when easing has helped.
    static constexpr double HELPED = 0.7;
    /// As TrialTuning::ROUNDING.
    static constexpr double ROUNDING = 1e-7;
};

/// Rigid tapping.
struct TapTuning {
    /// The helix counts as met within this part of a revolution, or so many steps of the encoder. At LOST, a
    /// quarter of a revolution, the tap is lost.
    static constexpr double MET = 1e-3, MET_STEPS = 2, LOST = 0.25;
    /// With jerk limits: a tap that would leave the helix by more while its spindle reverses is rejected
    /// [rev]. The change is seen late by the time of the speed measurement, of which half the square counts
    /// [s^2]. After a change the tool is on the helix again within so many times of A/J.
    static constexpr double MOST_OFF = 0.1, LATE_S2 = 2e-4, SETTLING = 2;
    /// The tool leaves the thread by this much before the spindle runs forward again [rev].
    static constexpr double CLEARANCE = 0.5;
    /// Clearance of the tool below the bottom in addition to the known overrun of the spindle, and minimum
    /// clearance before the start and below the bottom [rev].
    static constexpr double MORE_ROOM = 2, LEAST_ROOM = 1;
    /// Where joints are not axes: the spindle may run faster than now by this factor. The tool may be faster
    /// still, up to the limits of the joints, as long as their curves leave this part of the acceleration;
    /// number of speeds that are tried. A line without a speed has this one.
    static constexpr double OVERSPEED = 1.1, SPEED_WORTH = 0.9;
    static constexpr int SPEED_STEPS = 8;
    static constexpr double NO_SPEED = 1e-9;
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
    /// Part of the jerk limits that a stop without a planner takes; how finely its brake is chosen.
    static constexpr double FULL_JERK = 0.998;
    static constexpr int BRAKE_STEPS = 30;
    static constexpr int MOST_PIECES_PER_CYCLE = 64;
    /// A planner that makes no update for so long, and for so many cycles, in a drop is not waited for: four
    /// of its periods.
    static constexpr double PLANNER_SILENCE_S = 0.02;
    static constexpr int PLANNER_SILENCE_CYCLES = 4;
    /// Maximum wait for a plan to stop after a drop: the time of the committed part until it stops, and half
    /// of that.
    static constexpr double STOP_PLAN_WAIT_S = 0.15;
    /// The active plan, which was checked, is driven to its end where that takes at most this much longer
    /// than braking from here, which was not checked.
    static constexpr double LATER_S = 0.04;
};

}  // namespace mw::trajectory

// SPDX-License-Identifier: GPL-2.0-or-later
// Every figure of the planner and executor that was chosen, by the part that uses it, with its reason. Where
// the reason is a measurement, docs/developer/planner.md ("Figures") tells what another value costs.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace mw::trajectory {

/// What lines join, where a path stops, how it is cut into pieces.
struct PathTuning {
    /// Tangents that differ by less are the same but for rounding: the step of speed is below any limit.
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
    /// A line has a part of its own next to a blend if that is no longer than this part of it: less than
    /// half, so that both ends may have one and something is left between.
    static constexpr double ZONE_SHARE = 0.45;
    /// Part of the tolerance that joining lines may take when no other tolerance is given for it (corners
    /// need the rest), and at most (what joining takes, corners lose: half each).
    static constexpr double JOIN_SHARE = 0.1, MOST_JOIN_SHARE = 0.5;
    /// Lines that one may stand for: each new one asks all ends again, so this bounds the work of a block.
    static constexpr std::size_t MOST_JOINED = 64;
    /// What the mean may take where the program gives no tolerance: of a line's length, of an arc's radius,
    /// and at least the way in this time at the highest speed.
    static constexpr double FREE_OF_LENGTH = 0.1, FREE_OF_RADIUS = 1e-3, NOMINAL_S = 1e-4;
    /// How much longer than what suits a move the mean may be before a path of its own is worth its stop:
    /// speed on curves goes with 1/tau, so a fifth is lost at most.
    static constexpr double MOST_UNSUITED = 1.25;
    /// A blend is among others where a line beside it is shorter than this many times the way in the time of
    /// the mean: the zones on either side take one each.
    static constexpr double SHARED_REACH = 3.0;
};

/// Speeds and accelerations of a stretch (limits.cc).
struct LimitTuning {
    /// Share of an axis's acceleration that turning takes on a blend that is made for a given speed: at 0.7
    /// as much (sqrt(1 - 0.7^2) = 0.71 of a norm) is left for braking on it.
    static constexpr double BLEND_SHARE = 0.7;
    /// The mean is at most this part longer than what is best on curves: see docs/developer/planner.md.
    /// Measured: 0.96 is 0.8 % slower, 1.5 as fast.
    static constexpr double CURVE_SHARE = 1.2;
    /// Part of what rotary axes need for themselves that the mean has at least where they turn beside linear
    /// ones: where no tolerance makes it shorter, a stop of theirs takes twice as long as their
    /// limits need at most.
    static constexpr double TURNING_SHARE = 0.5;
    /// Room that keeps fitted stops (Executor) and rounding inside the limits.
    static constexpr double ACCELERATION_MARGIN = 1e-6;
    /// Parts of the highest squared speed between which the acceleration that is left is a chord: denser
    /// where a concave bound falls fastest.
    static constexpr double CHORDS[] = {0, 0.5, 0.85, 1};
};

/// Stops on curves (braking_on).
struct BrakingTuning {
    /// Where turning at the highest speed leaves this part of the acceleration, a stop by the sum is fast
    /// enough: the slower the more is left.
    static constexpr double ENOUGH = 0.5;
    /// An arc that turns by more than this has parts where other axes, or joints, move [rad].
    static constexpr double SWEEP = 0.2;
    /// A piece that takes no longer at its highest speed delays no stop [s]. Dense programs are planned twice
    /// as fast for it.
    static constexpr double SHORT_S = 0.002;
    /// As the speed falls turning leaves more: it is looked at anew where the squared speed has come down to
    /// a part, if that gives this many times as much, and not sooner than after SHORT_S. Who turns with
    /// nearly all that there is gains the more the sooner he looks.
    struct Look {
        double slower, gain;
    };
    static constexpr Look LOOKS[] = {{0.97, 1.5}, {0.9, 1.3}, {0.7, 1.05}};
    /// Turning at u of the highest squared speed leaves the root of 1 - u^2 on a circle, of which a chord
    /// from CHORDS is a small part near 1: who turns with all that there is would not get away from there.
    /// Without a mean, which a brake takes tau to get through, the bound has these parts and is looked at as
    /// often.
    static constexpr double DENSE_CHORDS[] = {0, 0.5, 0.85, 0.97, 0.995, 0.9995, 1};
    static constexpr Look DENSE_LOOKS[] = {{0.9995, 1.5}, {0.998, 1.3}, {0.99, 1.3},
                                           {0.97, 1.5},   {0.9, 1.3},   {0.7, 1.05}};
    /// Part of the highest speed with which such curves are driven, so that there is something to begin with.
    static constexpr double DENSE_DRIVEN = 1 - 5e-5;
    /// What derivatives may be more than their differences tell.
    static constexpr double MARGIN = 1.002;
    /// A bound of its own has to be better by so much somewhere.
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
    /// Places along the line, and the way over which derivatives are taken there: third differences of 1000
    /// mm are then exact to 1e-7, and no machine's curves are as narrow.
    static constexpr int PLACES = 33;
    static constexpr double STEP = 0.02;
    /// What rounding, or an inverse that iterates, makes of a joint's place, relative to it.
    static constexpr double ROUNDING = 1e-12;
    /// What derivatives may be more than their differences tell.
    static constexpr double MARGIN = 1.01;
    /// Part of acceleration and jerk that the curves of joints may take at the highest speed: the rest is for
    /// following the spindle.
    static constexpr double TURNING = 0.5;
};

/// Corners and arcs with jerk limits.
struct CornerTuning {
    /// Part of the tolerance that blends may take where corners follow each other closely, and what a slight
    /// turn is spread by. Measured: both are flat.
    static constexpr double GEOMETRY_SHARE = 0.35, SPREAD_SHARE = 0.05;
    /// Part of tau that the faster side of a slight turn may lose on its blend, which is passed at the speed
    /// of the slower.
    static constexpr double SPREAD_WORTH = 0.1;
    /// Part that the mean may take on an arc. Measured: less costs time; 0.96 gains up to 0.4 % with gentle
    /// jerk limits, nothing with stiff ones.
    static constexpr double ARC_SHARE = 0.92;
    /// Part of the tolerance that is planned with; the rest is for what the formulas leave out. Measured:
    /// less costs time.
    static constexpr double TOLERANCE_SHARE = 0.95;
    /// Up to this swing over what the mean can spread, less acceleration costs less time than standing does:
    /// about 2 tau (1 - 1/r) against tau - dwell. Measured.
    static constexpr double MOST_SWING = 1.7, GENTLE_ROOM = 0.999;
    /// From the width of a blend that takes BLEND_SHARE of the acceleration to one that takes 0.95.
    static constexpr double TURNING_FIT = LimitTuning::BLEND_SHARE / 0.95;
    /// Corners are dense where they are nearer than this part of the way in the time of the mean. Measured:
    /// flat.
    static constexpr double DENSE = 0.7;
    /// Part of the acceleration that is for turning where curves follow each other closely, and the least.
    /// Measured: 0.985 is as fast within 0.1 %, with less left for the path.
    static constexpr double TURNING_SHARE = 0.97, LEAST_TURNING = 0.02;
    /// What the turning of neighbours may be more than a place's own, and how much is left for that.
    /// Measured: 0.88 is 2.8 % slower, 1.375 0.4 %.
    static constexpr double SHARED_TURNS = 1.1, SHARED_REST = 0.985;
    /// A corner is passed where building up its speed and the stand saved take more than this part of tau.
    /// Measured: flat.
    static constexpr double PASS_WORTH = 0.8;
    /// A corner that is passed at what is gained in this part of tau is stopped at: the leader would keep
    /// such a speed for tau before and behind it. Measured: 0.02 to 0.1 the same.
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
    /// Part of the tolerance that the mean may take without help, and the most that corners are moved by:
    /// standing the path is outside by that, at speed inside by up to 0.95, so v may be sqrt(0.95 + 0.75)
    /// = 1.3 times as high. Measured: flat.
    static constexpr double FREE_SHARE = 0.95, MOST_SHARE = 0.75;
    /// Shifts follow the curvature over this part of the way in the time of the mean: a short part follows, a
    /// long one adds less curvature. Measured: flat.
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
    /// On exact arcs, which share their acceleration in fixed parts: the trial judges the mean place there,
    /// and what an axis does not take as it turns another has for braking.
    static constexpr std::array HARDER_SHARES{5.0, 2.5, 1.5};
    /// Speeds that differ by this part are the same.
    static constexpr double SAME_SPEED = 1e-9;
    /// A speed below this part of what one sample's acceleration gives is rounding.
    static constexpr double STANDING = 1e-13;
    /// Who stands no farther from the end of a piece is there [machine units].
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
    /// Attempts at a plan before the one before it stays in force.
    static constexpr int ATTEMPTS = 24;
    /// The same at rest, when all before were refused: nothing is in force then that could go on.
    static constexpr int ATTEMPTS_AT_REST = 96;
    /// Planner periods at rest without a plan, a second of them, before it is told.
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
    /// Relative room of a swing, for sums of rounding over the mean.
    static constexpr double ROUNDING = 1e-7;
    /// Relative slack of what the trial compares, half of what checkers of the trajectory allow.
    static constexpr double SLACK = 1.0 + 5e-7;
    /// Excess that stands for a limit that has no measure: the leader's own, or a joint's.
    static constexpr double UNMEASURED = 2;
};

/// Making slower what a trial has refused.
struct EasingTuning {
    /// Least and most part of speed and of acceleration that one attempt leaves.
    static constexpr double SLOWEST = 0.9, GENTLEST = 0.8, LEAST_SLOWER = 0.99, LEAST_GENTLER = 0.98;
    /// An excess that less acceleration about a stop may cure.
    static constexpr double MOST_GENTLE = 1.3;
    /// Part of the mean's time by which a stand becomes longer in one attempt, and how much of a stand the
    /// time that gentler pieces cost may be.
    static constexpr double STAND_STEP = 0.2, STAND_WORTH = 0.5;
    /// Less acceleration along the path cures an excess where that is what swings: from this part on, by how
    /// much more than that, and how much less it becomes at most in all.
    static constexpr double ALONG_SHARE = 0.5, ALONG_MARGIN = 1.1, ALONG_ROOM = 1e-4, LEAST_ALONG = 0.8;
    /// What is left of an excess when easing has helped.
    static constexpr double HELPED = 0.7;
    /// As TrialTuning::ROUNDING.
    static constexpr double ROUNDING = 1e-7;
};

/// Passes that are locked to a spindle, as they are planned.
struct PassTuning {
    /// The spindle may turn this much faster than now without a corner being too tight for its speed.
    static constexpr double SPEED_RESERVE = 1.1;
    /// And so much more, with a mean, between the planning of a corner and its passing; part of the second
    /// line that the corner may move into.
    static constexpr double LAG_RESERVE = 1.03, ROOM_SHARE = 0.95;
    /// Kept off the limits by what sums of rounding make.
    static constexpr double FULL = 0.9999;
    /// A load that is over what is possible by rounding alone.
    static constexpr double LOAD_ROUNDING = 1e-9;
    /// With jerk limits the acceleration may swing by what the mean can bring together: gaining speed takes
    /// one part, following the spindle the rest (0.88 + 0.11 < 1), and braking begins a mean later. A short
    /// pass shares evenly (2 * 0.49 < 1).
    static constexpr double LONG_SHARE = 0.88, LONG_TRIM = 0.11, SHORT_SHARE = 0.49;
    /// With corners turning takes TURNING, and gaining speed at the same time CORNER_SHARE of what that
    /// leaves: 0.3 + 0.7 * 0.4 + 0.4 < 1.
    static constexpr double CORNER_SHARE = 0.4, TURNING = 0.3;
    /// A pass is long from so many means at the spindle's speed on.
    static constexpr double LONG_MEANS = 3.0;
};

/// Rigid tapping.
struct TapTuning {
    /// Speed of the spindle is what it has turned in so many cycles: one count of 4,096 is then 0.03 turns/s
    /// at 1 ms. Its acceleration is smoothed over this time, and at least this part of a mean.
    static constexpr std::size_t SPEED_SAMPLES = 8;
    static constexpr double ACCELERATION_S = 0.01, ACCELERATION_MEANS = 0.4;
    /// The helix counts as met within this part of a turn: a few counts. From then on a deviation is made
    /// good at GAIN [1/s]; at LOST, a quarter of a turn, the thread or the tap is gone.
    static constexpr double MET = 1e-3, GAIN = 60, LOST = 0.25;
    /// Part of the acceleration with which the helix is met and the way home is made, and at most what the
    /// spindle's own change of speed may ask for.
    static constexpr double MEETING_SHARE = 0.97;
    /// With a mean: a tap that would be farther off the helix, as its spindle turns back, is refused [turns].
    /// The change is seen by this part of the mean late, and by what reading the speed takes, of which half
    /// the square counts [s^2]. Measured, for means from 0.02 to 0.2 s: docs/integrator/spindles.md.
    /// After a change the tool is on the helix again within so many means.
    static constexpr double MOST_OFF = 0.1, LATE_MEANS = 0.6, LATE_S2 = 2e-4, SETTLING_MEANS = 2;
    /// The tool leaves the thread by this much before the spindle turns forward again [turns].
    static constexpr double CLEARANCE = 0.5;
    /// Room that the tool has beyond its bottom on top of what the spindle is known to take, and that must be
    /// there before the start and behind the bottom [turns].
    static constexpr double MORE_ROOM = 2, LEAST_ROOM = 1;
    /// Where joints are not axes: the spindle may turn so much faster than now. The tool may go faster still,
    /// up to all that joints allow, as long as their curves leave this part of the acceleration; speeds that
    /// are tried. A line without a speed has this one.
    static constexpr double OVERSPEED = 1.1, SPEED_WORTH = 0.9;
    static constexpr int SPEED_STEPS = 8;
    static constexpr double NO_SPEED = 1e-9;
    /// And the room that is looked for beyond both ends of the line at most [turns]; what derivatives are
    /// taken over stays within it [machine units].
    static constexpr double MOST_ROOM = 25, ROOM_MARGIN = 3 * LineJointTuning::STEP;
    /// After a stop the tool goes on with a spindle that comes to a stand as it is known to, this many times
    /// as far and a turn more; so far where nothing is known. Slower than that it stands [turns/s].
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
    /// The helix counts as met within this part of a turn, and as lost beyond the second: what a count of the
    /// encoder makes of the angle half a mean later is within it.
    static constexpr double MET = 2e-5, LOST = 6e-3;
    /// It also counts as met where it was this near for so many cycles: a rough encoder does no better.
    static constexpr double NEAR = 2e-3;
    static constexpr int NEAR_CYCLES = 8;
    /// Or was on either side of it in turn: one with few counts tells the speed so roughly that it is never
    /// near.
    static constexpr int CROSSINGS = 3;
    /// Once it is met: share of a deviation that is made good in a second [1/s]. A rough encoder must not
    /// shake the machine.
    static constexpr double GAIN = 60;
    /// Part of the acceleration with which the helix is met: the spindle may still gain speed itself.
    static constexpr double MEETING_SHARE = 0.97;
    static constexpr int MOST_PIECES_PER_CYCLE = 64;
    /// A planner that makes no update for so long, and for so many cycles, in a drop is not waited for: four
    /// of its periods.
    static constexpr double PLANNER_SILENCE_S = 0.02;
    static constexpr int PLANNER_SILENCE_CYCLES = 4;
    /// A plan to stop that has not come so long after a drop is not waited for: as long as what is committed
    /// goes on before it stops, and half of that.
    static constexpr double STOP_PLAN_WAIT_S = 0.15;
    /// The plan in force, which was tried, is driven to its end where that takes no longer than braking from
    /// here, which was not, and so much more.
    static constexpr double LATER_S = 0.04;
};

}  // namespace mw::trajectory

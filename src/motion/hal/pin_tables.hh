// SPDX-License-Identifier: GPL-2.0-or-later
// Declares every pin of the motion controller once, with the names of the manual page motion(9). motmod.9,
// the pins created in HAL and the values copied in each servo cycle are generated from these tables.
#pragma once

#include <cmath>

#include "hal/sdk/pin_table.hh"
#include "motion/servo/io.hh"

namespace mw::motion {

/// What rows write from.
struct MotionView {
    const Outputs &out;
    std::int64_t last_period_ns = 0;
};
struct JointView {
    const JointStatus &s;
    const JointOutputs &o;
};
struct SpindleView {
    const SpindleStatus &s;
    const SpindleOutputs &o;
};
struct AxisInputs {
    WheelInput &wheel;
    OffsetInput &offset;
};
/// One input or output of several channels.
struct ChannelIn {
    Inputs &in;
    int number = 0;
};
struct ChannelOut {
    const Status &status;
    int number = 0;
};

namespace pins {

using sdk::in, sdk::in_out, sdk::out, sdk::pin_table, sdk::Unused;
using Count = std::int32_t;

constexpr double PER_MINUTE = 60.0, MM_PER_INCH = 25.4;

/// Feed of the executed cut [units/min].
inline double feed_upm(const Status &s) noexcept {
    const bool isFeed = s.motion_type == MotionType::FEED || s.motion_type == MotionType::ARC;
    return isFeed && !s.isPaused ? s.requested_velocity * s.net_feed_scale * PER_MINUTE : 0.0;
}

// clang-format off
inline constexpr auto MOTION = pin_table("motion",
    in<bool>("enable", "", "FALSE: the amplifiers go off in this cycle", [](Inputs &i, bool v) { i.isEnableOn = v; }, true),
    in<bool>("emc-enable-in", "", "the same, for the e-stop chain", [](Inputs &i, bool v) { i.isEnableOn = i.isEnableOn && v; }, true),
    in<bool>("probe-input", "", "the probe makes contact", [](Inputs &i, bool v) { i.isProbeClosed = v; }),
    in<bool>("feed-hold", "", "TRUE pauses the path where M53 allows it", [](Inputs &i, bool v) { i.isFeedHeld = v; }),
    in<bool>("feed-inhibit", "", "TRUE pauses the path", [](Inputs &i, bool v) { i.isFeedInhibited = v; }),
    in<bool>("homing-inhibit", "", "TRUE inhibits homing", [](Inputs &i, bool v) { i.isHomingInhibited = v; }),
    in<bool>("jog-inhibit", "", "TRUE inhibits jogs", [](Inputs &i, bool v) { i.isJogInhibited = v; }),
    in<bool>("jog-stop", "", "jogs stop within their limits", [](Inputs &i, bool v) { i.isJogStopped = v; }),
    in<bool>("jog-stop-immediate", "", "jogs stop in this cycle", [](Inputs &i, bool v) { i.isJogStoppedNow = v; }),
    in<double>("adaptive-feed", "", "factor of the feed with M52, -1 to 1; below 0 the path is run in reverse", [](Inputs &i, double v) { i.adaptive_feed = v; }, 1.0),
    out<bool>("coord-error", "", "the path was stopped by a fault", [](const MotionView &v) { return v.out.isCoordError; }),
    out<bool>("coord-mode", "", "coordinated mode (programs and MDI)", [](const MotionView &v) { return v.out.status.mode == Mode::COORD; }),
    out<bool>("teleop-mode", "", "teleop mode (axis jogs)", [](const MotionView &v) { return v.out.status.mode == Mode::TELEOP; }),
    out<bool>("in-position", "", "no motion is active or queued", [](const MotionView &v) { return v.out.status.isInPosition; }),
    out<bool>("is-all-homed", "", "every joint is homed", [](const MotionView &v) { return v.out.status.isAllHomed; }),
    out<bool>("jog-is-active", "", "a joint or axis is jogging", [](const MotionView &v) { return v.out.isJogging; }),
    out<bool>("motion-enabled", "", "machine on", [](const MotionView &v) { return v.out.status.isEnabled; }),
    out<bool>("on-soft-limit", "", "a joint is at a soft limit", [](const MotionView &v) { return v.out.isOnSoftLimit; }),
    out<bool>("tp-reverse", "", "the path is run in reverse", [](const MotionView &v) { return v.out.status.isReverse; }),
    out<bool>("eoffset-active", "", "an external offset is not zero", [](const MotionView &v) { return v.out.isOffsetActive; }),
    out<bool>("eoffset-limited", "", "a soft limit keeps an external offset below its request", [](const MotionView &v) { return v.out.isOffsetLimited; }),
    out<double>("current-vel", "unit/s", "speed along the path", [](const MotionView &v) { return v.out.status.current_velocity; }),
    out<double>("distance-to-go", "unit", "to the end of the move", [](const MotionView &v) { return v.out.status.distance_to_go; }),
    out<double>("requested-vel", "unit/s", "programmed speed of the move", [](const MotionView &v) { return v.out.status.requested_velocity; }),
    out<double>("feed-upm", "unit/min", "programmed feed with overrides; 0 in rapids", [](const MotionView &v) { return feed_upm(v.out.status); }),
    out<double>("feed-inches-per-minute", "inch/min", "the same", [](const MotionView &v) { return feed_upm(v.out.status) * v.out.mm_per_unit / MM_PER_INCH; }),
    out<double>("feed-inches-per-second", "inch/s", "the same", [](const MotionView &v) { return feed_upm(v.out.status) * v.out.mm_per_unit / MM_PER_INCH / PER_MINUTE; }),
    out<double>("feed-mm-per-minute", "mm/min", "the same", [](const MotionView &v) { return feed_upm(v.out.status) * v.out.mm_per_unit; }),
    out<double>("feed-mm-per-second", "mm/s", "the same", [](const MotionView &v) { return feed_upm(v.out.status) * v.out.mm_per_unit / PER_MINUTE; }),
    out<Count>("motion-type", "", "type of the move, 0: none", [](const MotionView &v) { return v.out.status.motion_type; }),
    out<Count>("program-line", "", "line of the move", [](const MotionView &v) { return v.out.status.source.line; }),
    out<std::uint32_t>("servo.last-period", "ns", "between the last two cycles", [](const MotionView &v) { return v.last_period_ns; }),
    out<Count>("interp.line-number", "", "line of the move", [](const MotionView &v) { return v.out.status.source.line; }),
    out<Count>("interp.motion-type", "", "ten times the G code of the move: 0, 10, 20, 30, 380 of probe moves", [](const MotionView &v) { return v.out.heading.g_code; }),
    out<double>("interp.feedrate", "unit/s", "programmed speed of the move", [](const MotionView &v) { return v.out.status.requested_velocity; }),
    out<double>("interp.arc-radius", "unit", "radius of the current arc; 0 on other moves", [](const MotionView &v) { return v.out.heading.radius; }),
    out<double>("interp.arc-center-x", "unit", "its centre, machine coordinates", [](const MotionView &v) { return v.out.heading.centre[0]; }),
    out<double>("interp.arc-center-y", "unit", "the same", [](const MotionView &v) { return v.out.heading.centre[1]; }),
    out<double>("interp.arc-center-z", "unit", "the same", [](const MotionView &v) { return v.out.heading.centre[2]; }),
    out<double>("interp.heading", "deg", "direction of motion in XY, counter-clockwise from X; keeps its value without motion", [](const MotionView &v) { return v.out.heading.direction_deg; }),
    out<double>("interp.normal-heading", "deg", "from the tool to the centre of its arc; on lines 90 degrees left of the heading", [](const MotionView &v) { return v.out.heading.to_centre_deg; }),
    out<bool>("interp.iscircle", "", "the move is an arc", [](const MotionView &v) { return v.out.heading.isArc; }));

inline constexpr auto DIGITAL = pin_table("motion",
    in<bool>("digital-in-##", "", "for M66", [](ChannelIn &c, bool v) { c.in.digital_in |= v ? std::uint64_t{1} << c.number : 0U; }),
    out<bool>("digital-out-##", "", "by M62 to M65", [](const ChannelOut &c) { return (c.status.digital_out >> c.number & 1U) != 0; }));

inline constexpr auto ANALOG = pin_table("motion",
    in<double>("analog-in-##", "", "for M66", [](ChannelIn &c, double v) { c.in.analog_in[static_cast<std::size_t>(c.number)] = v; }),
    out<double>("analog-out-##", "", "by M67 and M68", [](const ChannelOut &c) { return c.status.analog_out[static_cast<std::size_t>(c.number)]; }));

inline constexpr auto MISC_ERROR = pin_table("motion",
    in<bool>("misc-error-##", "", "TRUE: the machine stops within its limits and goes off", [](ChannelIn &c, bool v) { c.in.misc_errors |= v ? std::uint64_t{1} << c.number : 0U; }));

inline constexpr auto JOINT = pin_table("joint.#",
    in<double>("motor-pos-fb", "unit", "measured position of the motor", [](JointInputs &i, double v) { i.motor_pos_fb = v; }),
    in<bool>("pos-lim-sw-in", "", "upper limit switch", [](JointInputs &i, bool v) { i.isPosLimitClosed = v; }),
    in<bool>("neg-lim-sw-in", "", "lower limit switch", [](JointInputs &i, bool v) { i.isNegLimitClosed = v; }),
    in<bool>("amp-fault-in", "", "the amplifier has a fault", [](JointInputs &i, bool v) { i.isAmpFaulted = v; }),
    in<Count>("jog-counts", "", "counts of the jog wheel", [](JointInputs &i, Count v) { i.wheel.counts = v; }),
    in<bool>("jog-enable", "", "the jog wheel moves the joint", [](JointInputs &i, bool v) { i.wheel.isEnabled = v; }),
    in<bool>("jog-vel-mode", "", "the joint stops when the jog wheel stops", [](JointInputs &i, bool v) { i.wheel.isVelocityMode = v; }),
    in<double>("jog-scale", "unit", "distance per count", [](JointInputs &i, double v) { i.wheel.scale = v; }),
    in<double>("jog-accel-fraction", "", "fraction of the acceleration limit for the jog wheel", [](JointInputs &i, double v) { i.wheel.accel_fraction = v; }, 1.0),
    out<bool>("amp-enable-out", "", "the amplifier may be on", [](const JointView &v) { return v.o.isAmpEnabled; }),
    out<double>("motor-pos-cmd", "unit", "commanded position of the motor", [](const JointView &v) { return v.o.motor_pos_cmd; }),
    out<double>("pos-cmd", "unit", "commanded position", [](const JointView &v) { return v.s.pos_cmd; }),
    out<double>("pos-fb", "unit", "measured position", [](const JointView &v) { return v.s.pos_fb; }),
    out<double>("vel-cmd", "unit/s", "commanded speed", [](const JointView &v) { return v.s.vel_cmd; }),
    out<double>("acc-cmd", "unit/s2", "commanded acceleration", [](const JointView &v) { return v.o.acc_cmd; }),
    out<double>("coarse-pos-cmd", "unit", "commanded position", [](const JointView &v) { return v.o.coarse_pos; }),
    out<double>("f-error", "unit", "following error", [](const JointView &v) { return v.s.ferror; }),
    out<double>("f-error-lim", "unit", "following error that is allowed now", [](const JointView &v) { return v.o.ferror_limit; }),
    out<double>("free-pos-cmd", "unit", "target of a jog or homing move", [](const JointView &v) { return v.o.free_pos_cmd; }));

/// Written only when one of its values has changed, as all tables SELDOM_*. Pins that enable amplifiers are
/// written in every cycle.
inline constexpr auto SELDOM_JOINT = pin_table("joint.#",
    out<double>("motor-offset", "unit", "from joint to motor, set by homing", [](const JointView &v) { return v.o.motor_offset; }),
    out<double>("backlash-corr", "unit", "backlash to compensate", [](const JointView &v) { return v.o.backlash_raw; }),
    out<double>("backlash-filt", "unit", "backlash compensated until now", [](const JointView &v) { return v.o.backlash_filtered; }),
    out<double>("backlash-vel", "unit/s", "speed of the backlash compensation", [](const JointView &v) { return v.o.backlash_velocity; }),
    out<double>("free-vel-lim", "unit/s", "speed limit of a jog or homing move", [](const JointView &v) { return v.o.free_velocity_limit; }),
    out<bool>("active", "", "the joint is used", [](const JointView &v) { return v.s.isActive; }),
    out<bool>("in-position", "", "no jog or homing move is active", [](const JointView &v) { return v.s.isInPosition; }),
    out<bool>("error", "", "a fault, following error or limit switch", [](const JointView &v) { return v.s.isFaulted || v.s.isFerrorTripped || v.s.isOnPosHardLimit || v.s.isOnNegHardLimit; }),
    out<bool>("faulted", "", "amplifier fault", [](const JointView &v) { return v.s.isFaulted; }),
    out<bool>("f-errored", "", "the following error was too large", [](const JointView &v) { return v.s.isFerrorTripped; }),
    out<bool>("pos-hard-limit", "", "on the upper limit switch", [](const JointView &v) { return v.s.isOnPosHardLimit; }),
    out<bool>("neg-hard-limit", "", "on the lower limit switch", [](const JointView &v) { return v.s.isOnNegHardLimit; }),
    out<bool>("free-tp-enable", "", "a jog or homing move is active", [](const JointView &v) { return v.o.isFreePlanning; }),
    out<bool>("kb-jog-active", "", "jogged by command", [](const JointView &v) { return v.o.isKeyboardJogging; }),
    out<bool>("wheel-jog-active", "", "jogged by wheel", [](const JointView &v) { return v.o.isWheelJogging; }));

/// Not present if a homing module creates its own pins.
inline constexpr auto HOMING = pin_table("joint.#",
    in<bool>("home-sw-in", "", "home switch", [](JointInputs &i, bool v) { i.isHomeSwitchClosed = v; }),
    in_out<bool>("index-enable", "", "homing waits for the index pulse; the encoder clears it there", [](JointInputs &i, bool v) { i.isIndexEnabled = v; }, [](const JointView &v) { return v.o.isIndexEnabled; }));

inline constexpr auto SELDOM_HOMING = pin_table("joint.#",
    out<bool>("homed", "", "the joint is homed", [](const JointView &v) { return v.s.isHomed; }),
    out<bool>("homing", "", "the joint is being homed", [](const JointView &v) { return v.s.isHoming; }),
    out<Count>("home-state", "", "step of homing, 0: none", [](const JointView &v) { return v.o.home_state; }));

/// Only for joints in the unlock mask.
inline constexpr auto SWITCHABLE = pin_table("motion",
    in<double>("switchkins-type", "", "type of switchable kinematics; change it at standstill only", [](Inputs &i, double v) { i.kinematics_type = v; }));

inline constexpr auto UNLOCK = pin_table("joint.#",
    out<bool>("unlock", "", "requests the indexer to unlock before a move; only joints in unlock_joints_mask", [](const JointView &v) { return v.o.isUnlockWanted; }),
    in<bool>("is-unlocked", "", "the indexer is unlocked", [](JointInputs &i, bool v) { i.isUnlocked = v; }));

/// Only of extra joints.
inline constexpr auto POSTHOME = pin_table("joint.#",
    in<double>("posthome-cmd", "unit", "commanded position of an extra joint after homing", [](JointInputs &i, double v) { i.posthome_cmd = v; }));

inline constexpr auto AXIS = pin_table("axis.@",
    in<Count>("jog-counts", "", "counts of the jog wheel", [](AxisInputs &a, Count v) { a.wheel.counts = v; }),
    in<bool>("jog-enable", "", "the jog wheel moves the axis", [](AxisInputs &a, bool v) { a.wheel.isEnabled = v; }),
    in<bool>("jog-vel-mode", "", "the axis stops when the jog wheel stops", [](AxisInputs &a, bool v) { a.wheel.isVelocityMode = v; }),
    in<double>("jog-scale", "unit", "distance per count", [](AxisInputs &a, double v) { a.wheel.scale = v; }),
    in<double>("jog-accel-fraction", "", "fraction of the acceleration limit for the jog wheel", [](AxisInputs &a, double v) { a.wheel.accel_fraction = v; }, 1.0),
    in<Count>("eoffset-counts", "", "counts that change the external offset", [](AxisInputs &a, Count v) { a.offset.counts = v; }),
    in<bool>("eoffset-enable", "", "eoffset-counts change the external offset", [](AxisInputs &a, bool v) { a.offset.isEnabled = v; }),
    in<bool>("eoffset-clear", "", "the external offset moves to zero", [](AxisInputs &a, bool v) { a.offset.isClearing = v; }),
    in<double>("eoffset-scale", "unit", "distance per count", [](AxisInputs &a, double v) { a.offset.scale = v; }),
    out<double>("pos-cmd", "unit", "commanded position", [](const AxisOutputs &o) { return o.position; }),
    out<double>("teleop-pos-cmd", "unit", "commanded position of the jog", [](const AxisOutputs &o) { return o.teleop_position; }));

inline constexpr auto SELDOM_AXIS = pin_table("axis.@",
    out<double>("eoffset", "unit", "external offset", [](const AxisOutputs &o) { return o.offset; }),
    out<double>("eoffset-request", "unit", "target of the external offset", [](const AxisOutputs &o) { return o.offset_request; }),
    out<double>("teleop-vel-cmd", "unit/s", "speed of the jog", [](const AxisOutputs &o) { return o.teleop_velocity; }),
    out<double>("teleop-vel-lim", "unit/s", "speed limit of the jog", [](const AxisOutputs &o) { return o.teleop_velocity_limit; }),
    out<bool>("teleop-tp-enable", "", "a jog is active", [](const AxisOutputs &o) { return o.isTeleopPlanning; }),
    out<bool>("kb-jog-active", "", "jogged by command", [](const AxisOutputs &o) { return o.isKeyboardJogging; }),
    out<bool>("wheel-jog-active", "", "jogged by wheel", [](const AxisOutputs &o) { return o.isWheelJogging; }));

inline constexpr auto SPINDLE = pin_table("spindle.#",
    in<bool>("at-speed", "", "the spindle is at speed; feed moves wait for it", [](SpindleInputs &i, bool v) { i.isAtSpeed = v; }, true),
    in<bool>("inhibit", "", "TRUE stops the spindle", [](SpindleInputs &i, bool v) { i.isInhibited = v; }),
    in<bool>("is-oriented", "", "the spindle is at orient-angle", [](SpindleInputs &i, bool v) { i.isOriented = v; }),
    in<bool>("amp-fault-in", "", "TRUE: the machine stops within its limits and goes off", [](SpindleInputs &i, bool v) { i.isAmpFaulted = v; }),
    in<double>("revs", "turns", "revolutions of the encoder", [](SpindleInputs &i, double v) { i.revs = v; }),
    in<double>("speed-in", "turns/s", "measured speed", [](SpindleInputs &i, double v) { i.speed_in_rps = v; }),
    in<Count>("orient-fault", "", "not 0: orientation has failed", [](SpindleInputs &i, Count v) { i.orient_fault = v; }),
    in_out<bool>("index-enable", "", "index enable of the spindle encoder", [](SpindleInputs &i, bool v) { i.isIndexEnabled = v; }, Unused{}),
    out<double>("speed-out", "rpm", "commanded speed, below 0 backwards", [](const SpindleView &v) { return v.o.speed_rpm; }),
    out<double>("speed-out-abs", "rpm", "absolute value of speed-out", [](const SpindleView &v) { return std::abs(v.o.speed_rpm); }),
    out<double>("speed-out-rps", "turns/s", "commanded speed", [](const SpindleView &v) { return v.o.speed_rpm / PER_MINUTE; }),
    out<double>("speed-out-rps-abs", "turns/s", "absolute value of speed-out-rps", [](const SpindleView &v) { return std::abs(v.o.speed_rpm) / PER_MINUTE; }),
    out<double>("speed-cmd-rps", "turns/s", "programmed speed", [](const SpindleView &v) { return v.s.speed_cmd_rpm / PER_MINUTE; }),
    out<double>("orient-angle", "deg", "angle of the spindle orientation", [](const SpindleView &v) { return v.o.orient_angle; }),
    out<Count>("orient-mode", "", "0 shortest way, 1 clockwise, 2 counterclockwise", [](const SpindleView &v) { return v.o.orient_mode; }),
    out<bool>("on", "", "speed-out is not 0", [](const SpindleView &v) { return v.o.isOn; }),
    out<bool>("forward", "", "clockwise: speed-out is above 0", [](const SpindleView &v) { return v.o.isForward; }),
    out<bool>("reverse", "", "counterclockwise: speed-out is below 0", [](const SpindleView &v) { return v.o.isReverse; }),
    out<bool>("brake", "", "the brake is on", [](const SpindleView &v) { return v.o.isBrakeOn; }),
    out<bool>("orient", "", "requests a stop at orient-angle", [](const SpindleView &v) { return v.o.isOrienting; }),
    out<bool>("locked", "", "the spindle is at orient-angle", [](const SpindleView &v) { return v.o.isLocked; }));
// clang-format on

/// Calls `show(scope, row)` for every pin that the module can have.
template <class Show>
void for_each(Show &&show) {
    sdk::for_each_pin(MOTION, show);
    sdk::for_each_pin(DIGITAL, show);
    sdk::for_each_pin(ANALOG, show);
    sdk::for_each_pin(MISC_ERROR, show);
    sdk::for_each_pin(JOINT, show);
    sdk::for_each_pin(SELDOM_JOINT, show);
    sdk::for_each_pin(HOMING, show);
    sdk::for_each_pin(SELDOM_HOMING, show);
    sdk::for_each_pin(SWITCHABLE, show);
    sdk::for_each_pin(UNLOCK, show);
    sdk::for_each_pin(POSTHOME, show);
    sdk::for_each_pin(AXIS, show);
    sdk::for_each_pin(SELDOM_AXIS, show);
    sdk::for_each_pin(SPINDLE, show);
}

}  // namespace pins
}  // namespace mw::motion

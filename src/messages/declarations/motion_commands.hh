// SPDX-License-Identifier: GPL-2.0-or-later
// Commands about overrides, modes of motion, moves, offsets and outputs.
#pragma once

#include "base/limits.hh"
#include "messages/declarations/names.hh"

namespace mw::messages {

struct SetFeedOverride {
    double factor = 1.0;
};
template <>
inline constexpr auto DECLARED<SetFeedOverride> =
    declare("SetFeedOverride", 209, "EMC_TRAJ_SET_SCALE_TYPE", "scales programmed feeds and jogs",
            field<&SetFeedOverride::factor>("factor", "of the feed", unit::FACTOR, AT_LEAST_0));

struct SetRapidOverride {
    double factor = 1.0;
};
template <>
inline constexpr auto DECLARED<SetRapidOverride> =
    declare("SetRapidOverride", 238, "EMC_TRAJ_SET_RAPID_SCALE_TYPE", "scales rapids",
            field<&SetRapidOverride::factor>("factor", "of rapids", unit::FACTOR, AT_LEAST_0));

struct SetSpindleOverride {
    double factor = 1.0;
    int spindle = 0;
};
template <>
inline constexpr auto DECLARED<SetSpindleOverride> =
    declare("SetSpindleOverride", 233, "EMC_TRAJ_SET_SPINDLE_SCALE_TYPE", "scales the speed of a spindle",
            field<&SetSpindleOverride::factor>("factor", "of the speed", unit::FACTOR, AT_LEAST_0),
            optional(field<&SetSpindleOverride::spindle>("spindle", "number of the spindle", unit::NONE,
                                                         range(0, MAX_SPINDLES - 1))));

struct EnableFeedOverride {
    bool isOn = true;
};
template <>
inline constexpr auto DECLARED<EnableFeedOverride> =
    declare("EnableFeedOverride", 234, "EMC_TRAJ_SET_FO_ENABLE_TYPE", "lets feed overrides work, as M50",
            field<&EnableFeedOverride::isOn>("on", "they work"));

struct EnableSpindleOverride {
    bool isOn = true;
    int spindle = 0;
};
template <>
inline constexpr auto DECLARED<EnableSpindleOverride> =
    declare("EnableSpindleOverride", 235, "EMC_TRAJ_SET_SO_ENABLE_TYPE",
            "lets spindle overrides work, as M51", field<&EnableSpindleOverride::isOn>("on", "they work"),
            optional(field<&EnableSpindleOverride::spindle>("spindle", "number of the spindle", unit::NONE,
                                                            range(0, MAX_SPINDLES - 1))));

struct EnableFeedHold {
    bool isOn = true;
};
template <>
inline constexpr auto DECLARED<EnableFeedHold> =
    declare("EnableFeedHold", 236, "EMC_TRAJ_SET_FH_ENABLE_TYPE", "lets pin motion.feed-hold work, as M53",
            field<&EnableFeedHold::isOn>("on", "it works"));

struct EnableAdaptiveFeed {
    bool isOn = false;
};
template <>
inline constexpr auto DECLARED<EnableAdaptiveFeed> =
    declare("EnableAdaptiveFeed", 306, "EMC_MOTION_ADAPTIVE_TYPE",
            "lets pin motion.adaptive-feed work, as M52", field<&EnableAdaptiveFeed::isOn>("on", "it works"));

struct SetMaxVelocity {
    double velocity = 0;
};
template <>
inline constexpr auto DECLARED<SetMaxVelocity> =
    declare("SetMaxVelocity", 207, "EMC_TRAJ_SET_MAX_VELOCITY_TYPE", "bounds the speed along the path",
            field<&SetMaxVelocity::velocity>("velocity", "highest; those of axes and joints bound it as well",
                                             unit::SPEED, AT_LEAST_0));

struct SetTeleop {
    bool isTeleop = true;
};
template <>
inline constexpr auto DECLARED<SetTeleop> =
    declare("SetTeleop", 230, "EMC_TRAJ_SET_TELEOP_ENABLE_TYPE", "says what manual mode moves",
            field<&SetTeleop::isTeleop>("teleop", "true: axes; false: joints"));

struct SetMotionMode {
    MotionMode mode = MotionMode::FREE;
};
template <>
inline constexpr auto DECLARED<SetMotionMode> =
    declare("SetMotionMode", 204, "EMC_TRAJ_SET_MODE_TYPE", "sets the mode of motion",
            field<&SetMotionMode::mode>("mode", "wanted"));

struct SetTeleopVector {
    geometry::Pose velocity;
};
template <>
inline constexpr auto DECLARED<SetTeleopVector> =
    declare("SetTeleopVector", 231, "EMC_TRAJ_SET_TELEOP_VECTOR_TYPE",
            "moves all axes at once in teleop mode",
            field<&SetTeleopVector::velocity>("velocity", "of each axis", "machine units/s, degrees/s"));

struct SetTrajAxes {
    std::uint32_t axis_mask = 7;
};
template <>
inline constexpr auto DECLARED<SetTrajAxes> =
    declare("SetTrajAxes", 201, "EMC_TRAJ_SET_AXES_TYPE", "says which axes there are",
            field<&SetTrajAxes::axis_mask>("axis_mask", "bit 0 X ... bit 8 W", unit::NONE, range(0, 511)));

struct SetTrajUnits {
    double linear = 1;
    double angular = 1;
};
template <>
inline constexpr auto DECLARED<SetTrajUnits> =
    declare("SetTrajUnits", 202, "EMC_TRAJ_SET_UNITS_TYPE", "sets the units",
            field<&SetTrajUnits::linear>("linear", "per millimetre", unit::NONE, AT_LEAST_0),
            field<&SetTrajUnits::angular>("angular", "per degree", unit::NONE, AT_LEAST_0));

struct SetTrajCycleTime {
    double period_s = 0.001;
};
template <>
inline constexpr auto DECLARED<SetTrajCycleTime> =
    declare("SetTrajCycleTime", 203, "EMC_TRAJ_SET_CYCLE_TIME_TYPE", "sets the period of the planner",
            field<&SetTrajCycleTime::period_s>("period_s", "of the planner", unit::SECOND, AT_LEAST_0));

struct SetTrajVelocity {
    double velocity = 0;
};
template <>
inline constexpr auto DECLARED<SetTrajVelocity> =
    declare("SetTrajVelocity", 205, "EMC_TRAJ_SET_VELOCITY_TYPE", "sets the speed of the moves that follow",
            field<&SetTrajVelocity::velocity>("velocity", "along the path", unit::SPEED, AT_LEAST_0));

struct SetTrajAcceleration {
    double acceleration = 0;
};
template <>
inline constexpr auto DECLARED<SetTrajAcceleration> =
    declare("SetTrajAcceleration", 206, "EMC_TRAJ_SET_ACCELERATION_TYPE",
            "sets the acceleration of the moves that follow",
            field<&SetTrajAcceleration::acceleration>("acceleration", "along the path", unit::ACCELERATION,
                                                      AT_LEAST_0));

struct SetMaxAcceleration {
    double acceleration = 0;
};
template <>
inline constexpr auto DECLARED<SetMaxAcceleration> = declare(
    "SetMaxAcceleration", 208, "EMC_TRAJ_SET_MAX_ACCELERATION_TYPE", "bounds the acceleration along the path",
    field<&SetMaxAcceleration::acceleration>("acceleration", "highest", unit::ACCELERATION, AT_LEAST_0));

struct SetMotionId {
    int id = 0;
};
template <>
inline constexpr auto DECLARED<SetMotionId> =
    declare("SetMotionId", 210, "EMC_TRAJ_SET_MOTION_ID_TYPE", "sets the number of the move that follows",
            field<&SetMotionId::id>("id", "shown in the status"));

struct InitTraj {};
template <>
inline constexpr auto DECLARED<InitTraj> =
    declare("InitTraj", 211, "EMC_TRAJ_INIT_TYPE", "sets the planner up");

struct HaltTraj {};
template <>
inline constexpr auto DECLARED<HaltTraj> = declare("HaltTraj", 212, "EMC_TRAJ_HALT_TYPE", "ends the planner");

struct EnableTraj {};
template <>
inline constexpr auto DECLARED<EnableTraj> =
    declare("EnableTraj", 213, "EMC_TRAJ_ENABLE_TYPE", "enables motion");

struct DisableTraj {};
template <>
inline constexpr auto DECLARED<DisableTraj> =
    declare("DisableTraj", 214, "EMC_TRAJ_DISABLE_TYPE", "disables motion");

struct AbortTraj {};
template <>
inline constexpr auto DECLARED<AbortTraj> =
    declare("AbortTraj", 215, "EMC_TRAJ_ABORT_TYPE", "stops motion along its path");

struct PauseTraj {};
template <>
inline constexpr auto DECLARED<PauseTraj> = declare("PauseTraj", 216, "EMC_TRAJ_PAUSE_TYPE", "holds motion");

struct StepTraj {};
template <>
inline constexpr auto DECLARED<StepTraj> =
    declare("StepTraj", 217, "EMC_TRAJ_STEP_TYPE", "makes one move of a held queue");

struct ResumeTraj {};
template <>
inline constexpr auto DECLARED<ResumeTraj> =
    declare("ResumeTraj", 218, "EMC_TRAJ_RESUME_TYPE", "goes on after a hold");

struct Delay {
    double seconds = 0;
};
template <>
inline constexpr auto DECLARED<Delay> =
    declare("Delay", 219, "EMC_TRAJ_DELAY_TYPE", "waits",
            field<&Delay::seconds>("seconds", "how long", unit::SECOND, AT_LEAST_0));

struct LinearMove {
    geometry::Pose end;
    MoveKind kind = MoveKind::FEED;
    double velocity = 0;
    double acceleration = 0;
};
template <>
inline constexpr auto DECLARED<LinearMove> = declare(
    "LinearMove", 220, "EMC_TRAJ_LINEAR_MOVE_TYPE", "moves along a line",
    field<&LinearMove::end>("end", "end point", unit::POSE),
    field<&LinearMove::kind>("kind", "what the move is for"),
    field<&LinearMove::velocity>("velocity", "along the path", unit::SPEED, AT_LEAST_0),
    field<&LinearMove::acceleration>("acceleration", "along the path", unit::ACCELERATION, AT_LEAST_0));

struct CircularMove {
    geometry::Pose end;
    geometry::Pose center;
    geometry::Pose normal;
    int turn = 0;
    double velocity = 0;
    double acceleration = 0;
};
template <>
inline constexpr auto DECLARED<CircularMove> = declare(
    "CircularMove", 221, "EMC_TRAJ_CIRCULAR_MOVE_TYPE", "moves along an arc or helix",
    field<&CircularMove::end>("end", "end point", unit::POSE),
    field<&CircularMove::center>("center", "centre", unit::POSE),
    field<&CircularMove::normal>("normal", "axis of the turn", unit::POSE),
    field<&CircularMove::turn>("turn", "further whole turns; negative: clockwise", unit::NONE,
                               range(-100000, 100000)),
    field<&CircularMove::velocity>("velocity", "along the path", unit::SPEED, AT_LEAST_0),
    field<&CircularMove::acceleration>("acceleration", "along the path", unit::ACCELERATION, AT_LEAST_0));

struct SetTermination {
    int condition = 2;
    double tolerance = 0;
};
template <>
inline constexpr auto DECLARED<SetTermination> =
    declare("SetTermination", 222, "EMC_TRAJ_SET_TERM_COND_TYPE", "says how moves are joined",
            field<&SetTermination::condition>("condition", "1 exact stop, 2 blended, 3 exact path",
                                              unit::NONE, range(1, 3)),
            field<&SetTermination::tolerance>("tolerance", "of blends", unit::LENGTH, AT_LEAST_0));

struct SetToolOffset {
    geometry::Pose offset;
};
template <>
inline constexpr auto DECLARED<SetToolOffset> =
    declare("SetToolOffset", 223, "EMC_TRAJ_SET_OFFSET_TYPE", "sets the tool offset in force",
            field<&SetToolOffset::offset>("offset", "of the tool", unit::POSE));

struct SetG5x {
    int index = 1;
    geometry::Pose origin;
};
template <>
inline constexpr auto DECLARED<SetG5x> =
    declare("SetG5x", 224, "EMC_TRAJ_SET_G5X_TYPE", "sets a work offset",
            field<&SetG5x::index>("index", "1 G54 ... 9 G59.3", unit::NONE, range(1, 9)),
            field<&SetG5x::origin>("origin", "of the coordinate system", unit::POSE));

struct SetTrajHome {
    geometry::Pose home;
};
template <>
inline constexpr auto DECLARED<SetTrajHome> =
    declare("SetTrajHome", 225, "EMC_TRAJ_SET_HOME_TYPE", "sets the position after homing",
            field<&SetTrajHome::home>("home", "position", unit::POSE));

struct SetRotation {
    double angle_deg = 0;
};
template <>
inline constexpr auto DECLARED<SetRotation> =
    declare("SetRotation", 226, "EMC_TRAJ_SET_ROTATION_TYPE", "sets the rotation of the coordinate system",
            field<&SetRotation::angle_deg>("angle_deg", "about Z", unit::DEGREE));

struct SetG92 {
    geometry::Pose origin;
};
template <>
inline constexpr auto DECLARED<SetG92> =
    declare("SetG92", 227, "EMC_TRAJ_SET_G92_TYPE", "sets the G92 offset",
            field<&SetG92::origin>("origin", "offset", unit::POSE));

struct ClearProbe {};
template <>
inline constexpr auto DECLARED<ClearProbe> = declare(
    "ClearProbe", 228, "EMC_TRAJ_CLEAR_PROBE_TRIPPED_FLAG_TYPE", "forgets that the probe has tripped");

struct ProbeMove {
    geometry::Pose end;
    double velocity = 0;
    int kind = 0;
};
template <>
inline constexpr auto DECLARED<ProbeMove> =
    declare("ProbeMove", 229, "EMC_TRAJ_PROBE_TYPE", "moves until the probe trips",
            field<&ProbeMove::end>("end", "end point", unit::POSE),
            field<&ProbeMove::velocity>("velocity", "along the path", unit::SPEED, AT_LEAST_0),
            field<&ProbeMove::kind>("kind", "as G38.2 (0) to G38.5 (3)", unit::NONE, range(0, 3)));

struct SetSpindleSync {
    int spindle = 0;
    double feed_per_revolution = 0;
    bool isVelocityOnly = false;
};
template <>
inline constexpr auto DECLARED<SetSpindleSync> =
    declare("SetSpindleSync", 232, "EMC_TRAJ_SET_SPINDLESYNC_TYPE", "moves in step with a spindle",
            optional(field<&SetSpindleSync::spindle>("spindle", "number of the spindle", unit::NONE,
                                                     range(0, MAX_SPINDLES - 1))),
            field<&SetSpindleSync::feed_per_revolution>("feed_per_revolution", "0: no longer",
                                                        "machine units/revolution"),
            field<&SetSpindleSync::isVelocityOnly>("velocity_only", "speed is followed, not position"));

struct RigidTapMove {
    geometry::Pose end;
    double velocity = 0;
    double scale = 1.0;
};
template <>
inline constexpr auto DECLARED<RigidTapMove> =
    declare("RigidTapMove", 237, "EMC_TRAJ_RIGID_TAP_TYPE", "taps to a depth and back",
            field<&RigidTapMove::end>("end", "end point", unit::POSE),
            field<&RigidTapMove::velocity>("velocity", "along the path", unit::SPEED, AT_LEAST_0),
            field<&RigidTapMove::scale>("scale", "of the speed of the way back", unit::FACTOR, AT_LEAST_0));

struct InitMotion {};
template <>
inline constexpr auto DECLARED<InitMotion> =
    declare("InitMotion", 301, "EMC_MOTION_INIT_TYPE", "sets motion up");

struct HaltMotion {};
template <>
inline constexpr auto DECLARED<HaltMotion> =
    declare("HaltMotion", 302, "EMC_MOTION_HALT_TYPE", "ends motion");

struct AbortMotion {};
template <>
inline constexpr auto DECLARED<AbortMotion> =
    declare("AbortMotion", 303, "EMC_MOTION_ABORT_TYPE", "stops motion along its path");

struct SetAnalogOutput {
    int index = 0;
    double value = 0;
};
template <>
inline constexpr auto DECLARED<SetAnalogOutput> = declare(
    "SetAnalogOutput", 304, "EMC_MOTION_SET_AOUT_TYPE", "sets pin motion.analog-out-NN at once",
    field<&SetAnalogOutput::index>("index", "number of the output", unit::NONE, range(0, MAX_ANALOG_IO - 1)),
    field<&SetAnalogOutput::value>("value", "of the pin"));

struct SetDigitalOutput {
    int index = 0;
    bool isOn = false;
};
template <>
inline constexpr auto DECLARED<SetDigitalOutput> =
    declare("SetDigitalOutput", 305, "EMC_MOTION_SET_DOUT_TYPE", "sets pin motion.digital-out-NN at once",
            field<&SetDigitalOutput::index>("index", "number of the output", unit::NONE,
                                            range(0, MAX_DIGITAL_IO - 1)),
            field<&SetDigitalOutput::isOn>("on", "value of the pin"));

}  // namespace mw::messages

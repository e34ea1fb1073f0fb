// SPDX-License-Identifier: GPL-2.0-or-later
// The immediate channel into the motion controller: read by the servo thread, a bounded number per cycle.
// Lengths in machine units, angles in degrees, times in seconds, unless the name has a unit.
#pragma once

#include <cstdint>
#include <variant>

#include "base/geometry/pose.hh"

namespace mw::motion {

/// Commands of an epoch older than the controller's are answered STALE and do nothing.
using Epoch = std::uint32_t;
/// Unique per task process run, increasing, never 0.
using CommandId = std::uint64_t;

enum class Mode : std::uint8_t { FREE, TELEOP, COORD };  ///< requirement A4

// --- state
// -----------------------------------------------------------------------------------------------------
/// Stops everything at its own limits (coord: along the path) and makes `new_epoch` the current one.
struct Abort {
    Epoch new_epoch = 0;
};
struct Enable {};   ///< amps on; the commanded position is taken from feedback
struct Disable {};  ///< amps off in this cycle
struct SetMode {
    Mode mode = Mode::FREE;
};
struct SetAmplifier {  ///< ENABLE_AMPLIFIER, DISABLE_AMPLIFIER of one joint
    int joint = 0;
    bool isOn = false;
};
struct SetJointActive {  ///< ACTIVATE_JOINT, DEACTIVATE_JOINT
    int joint = 0;
    bool isActive = true;
};
/// Number of loaded joints that the machine uses (SET_NUM_JOINTS); initially all.
struct SetNumJoints {
    int count = 0;
};
struct OverrideLimits {
    bool isOn = true;  ///< ends with the next jog
};
/// The watchdog on the task process: no Heartbeat for `timeout_s` means a stop of category 1.
struct SetWatchdog {
    bool isOn = false;
    double timeout_s = 0.5;
};
struct Heartbeat {};

// --- program flow
// ----------------------------------------------------------------------------------------------
struct Pause {};
struct Resume {};
struct StepOnce {};  ///< resume, and pause again at the end of the current source block
struct SetReverse {
    bool isReverse = false;
};

// --- scaling
// ---------------------------------------------------------------------------------------------------
enum class Scale : std::uint8_t { FEED, RAPID, SPINDLE };
struct SetScale {
    Scale what = Scale::FEED;
    int spindle = 0;
    double factor = 1.0;  ///< >= 0
};
enum class Switch : std::uint8_t { FEED_OVERRIDE, SPINDLE_OVERRIDE, ADAPTIVE_FEED, FEED_HOLD };
struct SetSwitch {
    Switch what = Switch::FEED_OVERRIDE;
    int spindle = 0;
    bool isEnabled = true;
};
struct SetMaxVelocity {
    double velocity = 0;  ///< operator's ceiling [machine units/s]; >= 0
};

// --- jogs and homing
// -------------------------------------------------------------------------------------------
/// A joint in free mode, an axis in teleop mode.
struct JogTarget {
    bool isJoint = true;
    int index = 0;
};
/// A lease that is not renewed ends the jog, even if task and the client have ended. The same command renews
/// it and may change velocity and lease.
inline constexpr double SHORTEST_JOG_LEASE_S = 0.02, LONGEST_JOG_LEASE_S = 10;
struct JogContinuous {
    JogTarget target;
    double velocity = 0;     ///< signed
    double lease_s = 0;      ///< 0: runs until it is stopped
    bool isRenewal = false;  ///< continues a jog that has a lease, never begins one
};
struct JogIncremental {
    JogTarget target;
    double velocity = 0;  ///< > 0
    double distance = 0;  ///< signed; adds to an active jog
};
struct JogAbsolute {
    JogTarget target;
    double velocity = 0;  ///< > 0
    double position = 0;
};
struct JogStop {
    JogTarget target;
};
struct Home {
    int joint = -1;  ///< -1: all, by sequence
};
struct Unhome {
    int joint = -1;  ///< -1: all; -2: those with volatile home
};
struct SetTeleopVector {
    geometry::Pose velocity;
};

// --- spindle and outputs, at once
// ------------------------------------------------------------------------------
struct SpindleOn {
    int spindle = 0;
    double speed_rpm = 0;     ///< signed: > 0 clockwise
    double css_factor = 0;    ///< surface speed / (2 pi) [machine units/min]; 0: constant rpm
    double css_max_rpm = 0;   ///< > 0 with a css_factor
    double css_x_offset = 0;  ///< machine X of the axis of rotation [machine units]
    bool isWaitingForSpeed = true;
};
struct SpindleOff {
    int spindle = 0;
};
struct SpindleOrient {
    int spindle = 0;
    double angle_deg = 0;
    int mode = 0;
};
struct SpindleBrake {
    int spindle = 0;
    bool isOn = false;
};
struct SetDigitalOutput {
    int index = 0;
    bool isOn = false;
};
struct SetAnalogOutput {
    int index = 0;
    double value = 0;
};
struct ClearProbeFlag {};
/// The tool length changes here: the path before it cannot be run in reverse. Moves nothing; the pins
/// motion.tooloffset.L belong to the I/O controller.
struct SetToolOffset {
    geometry::Pose offset;
};

// --- configuration
// ---------------------------------------------------------------------------------------------
/// One mechanism for every setting (requirement C7): declared once in motion/interface/parameters.hh.
struct SetParameter {
    std::uint16_t parameter = 0;  ///< motion::Parameter
    std::int16_t index = 0;       ///< joint, axis or spindle; 0 for machine-wide ones
    double value = 0;
};

inline constexpr int MAX_SCREW_POINTS = 10000;
/// Maximum slope of a table of screw errors [units per unit]; the rest of the joint's limits is for changes
/// of direction.
inline constexpr double STEEPEST_SCREW = 0.25;
/// One point of a table of screw errors (LOAD_COMP), in order. The table is active once it is complete, and
/// replaces backlash.
struct LoadCompensation {
    int joint = 0;
    int index = 0, count = 0;         ///< of `count` points; count 0: removes the table
    double nominal = 0;               ///< position of the joint, larger than that of the point before
    double forward = 0, reverse = 0;  ///< to be added to the motor's on the way up and down
};

using CommandBody =
    std::variant<Abort, Enable, Disable, SetMode, SetAmplifier, SetJointActive, SetNumJoints, OverrideLimits,
                 SetWatchdog, Heartbeat, Pause, Resume, StepOnce, SetReverse, SetScale, SetSwitch,
                 SetMaxVelocity, JogContinuous, JogIncremental, JogAbsolute, JogStop, Home, Unhome,
                 SetTeleopVector, SpindleOn, SpindleOff, SpindleOrient, SpindleBrake, SetDigitalOutput,
                 SetAnalogOutput, ClearProbeFlag, SetParameter, SetToolOffset, LoadCompensation>;

struct Command {
    CommandId id = 0;
    Epoch epoch = 0;
    CommandBody body;
};

}  // namespace mw::motion

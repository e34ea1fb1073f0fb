// SPDX-License-Identifier: GPL-2.0-or-later
// The immediate channel into the motion controller: the servo thread reads up to a fixed number of commands
// per cycle. Lengths in machine units, angles in degrees, times in seconds, unless the name has a unit.
#pragma once

#include <cstdint>
#include <variant>

#include "base/geometry/pose.hh"

namespace mw::motion {

/// Commands of an epoch older than the controller's are answered STALE and have no effect.
using Epoch = std::uint32_t;
/// Unique for each run of the task process; increasing; never 0.
using CommandId = std::uint64_t;

enum class Mode : std::uint8_t { FREE, TELEOP, COORD };  ///< requirement A4

// --- state
// -----------------------------------------------------------------------------------------------------
/// Stops everything at its own limits (coord: along the path) and makes `new_epoch` the current one.
struct Abort {
    Epoch new_epoch = 0;
};
struct Enable {};   ///< switches the amplifiers on; the feedback becomes the commanded position
struct Disable {};  ///< switches the amplifiers off in this cycle
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
    bool isOn = true;  ///< the override ends with the next jog
};
/// The watchdog monitors the task process. Without a Heartbeat for `timeout_s`, it triggers a stop of
/// category 1.
struct SetWatchdog {
    bool isOn = false;
    double timeout_s = 0.5;
};
struct Heartbeat {};

// --- program flow
// ----------------------------------------------------------------------------------------------
struct Pause {};
struct Resume {};
struct StepOnce {};  ///< resumes, and pauses at the end of the current source block
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
/// A jog that is not renewed within its lease ends, even if task and the client have ended. Sending the same
/// command again renews the lease and may change velocity and lease.
inline constexpr double SHORTEST_JOG_LEASE_S = 0.02, LONGEST_JOG_LEASE_S = 10;
struct JogContinuous {
    JogTarget target;
    double velocity = 0;     ///< signed
    double lease_s = 0;      ///< 0: runs until it is stopped
    bool isRenewal = false;  ///< continues a jog that has a lease; never starts one
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
/// Changes the tool length. The path before this point cannot be run in reverse. No joint moves; the pins
/// motion.tooloffset.L belong to the I/O controller.
struct SetToolOffset {
    geometry::Pose offset;
};

// --- configuration
// ---------------------------------------------------------------------------------------------
/// One command for all settings (requirement C7), which motion/interface/parameters.hh declares.
struct SetParameter {
    std::uint16_t parameter = 0;  ///< motion::Parameter
    std::int16_t index = 0;       ///< joint, axis or spindle; 0 for settings of the whole machine
    double value = 0;
};

inline constexpr int MAX_SCREW_POINTS = 10000;
/// Maximum slope of a screw compensation table [units per unit]. The rest of the joint's limits is for
/// changes of direction.
inline constexpr double STEEPEST_SCREW = 0.25;
/// One point of a screw compensation table (LOAD_COMP), in order. The table becomes active when it is
/// complete. It replaces backlash.
struct LoadCompensation {
    int joint = 0;
    int index = 0, count = 0;         ///< index of a point, of `count` points; count 0: removes the table
    double nominal = 0;               ///< position of the joint, larger than that of the previous point
    double forward = 0, reverse = 0;  ///< added to the motor position in positive and negative travel
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

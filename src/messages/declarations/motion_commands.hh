// SPDX-License-Identifier: GPL-2.0-or-later
// Commands for overrides, motion modes, moves, offsets and outputs.
#pragma once

#include "base/limits.hh"
#include "messages/declarations/names.hh"

namespace mw::messages {

struct SetFeedOverride {
    double factor = 1.0;
};
template <>
inline constexpr auto DECLARED<SetFeedOverride> =
    declare("SetFeedOverride", 209, "scales programmed feeds and jogs",
            field<&SetFeedOverride::factor>("factor", "of the feed", unit::FACTOR, AT_LEAST_0));

struct SetRapidOverride {
    double factor = 1.0;
};
template <>
inline constexpr auto DECLARED<SetRapidOverride> =
    declare("SetRapidOverride", 238, "scales rapids",
            field<&SetRapidOverride::factor>("factor", "of rapids", unit::FACTOR, AT_LEAST_0));

struct SetSpindleOverride {
    double factor = 1.0;
    int spindle = 0;
};
template <>
inline constexpr auto DECLARED<SetSpindleOverride> =
    declare("SetSpindleOverride", 233, "scales the speed of a spindle",
            field<&SetSpindleOverride::factor>("factor", "of the speed", unit::FACTOR, AT_LEAST_0),
            optional(field<&SetSpindleOverride::spindle>("spindle", "number of the spindle", unit::NONE,
                                                         range(0, MAX_SPINDLES - 1))));

struct EnableFeedOverride {
    bool isOn = true;
};
template <>
inline constexpr auto DECLARED<EnableFeedOverride> =
    declare("EnableFeedOverride", 234, "lets feed overrides work, as M50",
            field<&EnableFeedOverride::isOn>("on", "they work"));

struct EnableSpindleOverride {
    bool isOn = true;
    int spindle = 0;
};
template <>
inline constexpr auto DECLARED<EnableSpindleOverride> =
    declare("EnableSpindleOverride", 235, "lets spindle overrides work, as M51",
            field<&EnableSpindleOverride::isOn>("on", "they work"),
            optional(field<&EnableSpindleOverride::spindle>("spindle", "number of the spindle", unit::NONE,
                                                            range(0, MAX_SPINDLES - 1))));

struct EnableFeedHold {
    bool isOn = true;
};
template <>
inline constexpr auto DECLARED<EnableFeedHold> =
    declare("EnableFeedHold", 236, "lets pin motion.feed-hold work, as M53",
            field<&EnableFeedHold::isOn>("on", "it works"));

struct EnableAdaptiveFeed {
    bool isOn = false;
};
template <>
inline constexpr auto DECLARED<EnableAdaptiveFeed> =
    declare("EnableAdaptiveFeed", 306, "lets pin motion.adaptive-feed work, as M52",
            field<&EnableAdaptiveFeed::isOn>("on", "it works"));

struct SetMaxVelocity {
    double velocity = 0;
};
template <>
inline constexpr auto DECLARED<SetMaxVelocity> =
    declare("SetMaxVelocity", 207, "bounds the speed along the path",
            field<&SetMaxVelocity::velocity>("velocity", "highest; those of axes and joints bound it as well",
                                             unit::SPEED, AT_LEAST_0));

struct SetTeleop {
    bool isTeleop = true;
};
template <>
inline constexpr auto DECLARED<SetTeleop> =
    declare("SetTeleop", 230, "says what manual mode moves",
            field<&SetTeleop::isTeleop>("teleop", "true: axes; false: joints"));

struct SetMotionMode {
    MotionMode mode = MotionMode::FREE;
};
template <>
inline constexpr auto DECLARED<SetMotionMode> =
    declare("SetMotionMode", 204, "sets the mode of motion", field<&SetMotionMode::mode>("mode", "wanted"));

struct SetTeleopVector {
    geometry::Pose velocity;
};
template <>
inline constexpr auto DECLARED<SetTeleopVector> =
    declare("SetTeleopVector", 231, "moves all axes at once in teleop mode",
            field<&SetTeleopVector::velocity>("velocity", "of each axis", "machine units/s, degrees/s"));

struct ClearProbe {};
template <>
inline constexpr auto DECLARED<ClearProbe> = declare("ClearProbe", 228, "forgets that the probe has tripped");

struct SetSpindleSync {
    int spindle = 0;
    double feed_per_revolution = 0;
    bool isVelocityOnly = false;
};
template <>
inline constexpr auto DECLARED<SetSpindleSync> =
    declare("SetSpindleSync", 232, "moves in step with a spindle",
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
    declare("RigidTapMove", 237, "taps to a depth and back",
            field<&RigidTapMove::end>("end", "end point", unit::POSE),
            field<&RigidTapMove::velocity>("velocity", "along the path", unit::SPEED, AT_LEAST_0),
            field<&RigidTapMove::scale>("scale", "of the retract speed", unit::FACTOR, AT_LEAST_0));

struct SetAnalogOutput {
    int index = 0;
    double value = 0;
};
template <>
inline constexpr auto DECLARED<SetAnalogOutput> = declare(
    "SetAnalogOutput", 304, "sets pin motion.analog-out-NN at once",
    field<&SetAnalogOutput::index>("index", "number of the output", unit::NONE, range(0, MAX_ANALOG_IO - 1)),
    field<&SetAnalogOutput::value>("value", "of the pin"));

struct SetDigitalOutput {
    int index = 0;
    bool isOn = false;
};
template <>
inline constexpr auto DECLARED<SetDigitalOutput> =
    declare("SetDigitalOutput", 305, "sets pin motion.digital-out-NN at once",
            field<&SetDigitalOutput::index>("index", "number of the output", unit::NONE,
                                            range(0, MAX_DIGITAL_IO - 1)),
            field<&SetDigitalOutput::isOn>("on", "value of the pin"));

}  // namespace mw::messages

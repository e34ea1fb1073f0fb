// SPDX-License-Identifier: GPL-2.0-or-later
// Commands for joints and jogs.
#pragma once

#include "base/limits.hh"
#include "messages/declarations/names.hh"

namespace mw::messages {

inline constexpr Range JOINTS{0, MAX_JOINTS - 1};

struct HomeJoint {
    int joint = -1;
};
template <>
inline constexpr auto DECLARED<HomeJoint> = declare(
    "HomeJoint", 123, "homes; done when homed",
    field<&HomeJoint::joint>("joint", "-1: all, in their sequence", unit::NONE, range(-1, MAX_JOINTS - 1)));

struct UnhomeJoint {
    int joint = -1;
};
template <>
inline constexpr auto DECLARED<UnhomeJoint> =
    declare("UnhomeJoint", 135, "forgets that joints are homed",
            field<&UnhomeJoint::joint>("joint", "-1: all; -2: those of VOLATILE_HOME", unit::NONE,
                                       range(-2, MAX_JOINTS - 1)));

/// Minimum of a lease that is not 0. [ms]
inline constexpr int SHORTEST_JOG_LEASE_MS = 20, LONGEST_JOG_LEASE_MS = 10000;
struct JogContinuous {
    bool isJoint = true;
    int index = 0;
    double velocity = 0;
    int lease_ms = 0;
    bool isRenewal = false;
};
template <>
inline constexpr auto DECLARED<JogContinuous> = declare(
    "JogContinuous", 124,
    "moves until it is stopped, or until its lease ends; the same command again renews the lease",
    field<&JogContinuous::isJoint>("is_joint", "true: a joint, in free mode; false: an axis, in teleop mode"),
    field<&JogContinuous::index>("index", "number of the joint, or of the axis: 0 X ... 8 W", unit::NONE,
                                 JOINTS),
    field<&JogContinuous::velocity>("velocity", "the sign is the direction", unit::JOINT_SPEED),
    optional(field<&JogContinuous::lease_ms>(
        "lease_ms", "motion ends the jog when it is not renewed within so long, at least 20; 0: no lease",
        unit::MILLISECOND, range(0, LONGEST_JOG_LEASE_MS))),
    optional(field<&JogContinuous::isRenewal>(
        "is_renewal",
        "true: renews the lease of an active jog and never starts one, so that a stopped jog does "
        "not continue; a rejection is reported to its client only")));

struct JogIncrement {
    bool isJoint = true;
    int index = 0;
    double velocity = 0;
    double distance = 0;
};
template <>
inline constexpr auto DECLARED<JogIncrement> = declare(
    "JogIncrement", 125, "moves by a distance",
    field<&JogIncrement::isJoint>("is_joint", "true: a joint, in free mode; false: an axis, in teleop mode"),
    field<&JogIncrement::index>("index", "number of the joint, or of the axis: 0 X ... 8 W", unit::NONE,
                                JOINTS),
    field<&JogIncrement::velocity>("velocity", "its amount counts", unit::JOINT_SPEED),
    field<&JogIncrement::distance>("distance", "the sign is the direction", unit::JOINT));

struct JogAbsolute {
    bool isJoint = true;
    int index = 0;
    double velocity = 0;
    double position = 0;
};
template <>
inline constexpr auto DECLARED<JogAbsolute> = declare(
    "JogAbsolute", 126, "moves to a position",
    field<&JogAbsolute::isJoint>("is_joint", "true: a joint, in free mode; false: an axis, in teleop mode"),
    field<&JogAbsolute::index>("index", "number of the joint, or of the axis: 0 X ... 8 W", unit::NONE,
                               JOINTS),
    field<&JogAbsolute::velocity>("velocity", "its amount counts", unit::JOINT_SPEED),
    field<&JogAbsolute::position>("position", "where to", unit::JOINT));

struct JogStop {
    bool isJoint = true;
    int index = 0;
};
template <>
inline constexpr auto DECLARED<JogStop> = declare(
    "JogStop", 136, "ends a jog",
    field<&JogStop::isJoint>("is_joint", "true: a joint, in free mode; false: an axis, in teleop mode"),
    field<&JogStop::index>("index", "number of the joint, or of the axis: 0 X ... 8 W", unit::NONE, JOINTS));

/// Effective until the next jog.

struct OverrideLimits {
    int joint = -1;
};
template <>
inline constexpr auto DECLARED<OverrideLimits> = declare(
    "OverrideLimits", 129, "lets joints be jogged off their hard limits, until the next jog",
    optional(field<&OverrideLimits::joint>("joint", "-1: all", unit::NONE, range(-1, MAX_JOINTS - 1))));

struct SetJointMinLimit {
    int joint = 0;
    double limit = 0;
};
template <>
inline constexpr auto DECLARED<SetJointMinLimit> =
    declare("SetJointMinLimit", 107, "sets the lower soft limit",
            field<&SetJointMinLimit::joint>("joint", "number of the joint", unit::NONE, JOINTS),
            field<&SetJointMinLimit::limit>("limit", "lowest position", unit::JOINT));

struct SetJointMaxLimit {
    int joint = 0;
    double limit = 0;
};
template <>
inline constexpr auto DECLARED<SetJointMaxLimit> =
    declare("SetJointMaxLimit", 108, "sets the upper soft limit",
            field<&SetJointMaxLimit::joint>("joint", "number of the joint", unit::NONE, JOINTS),
            field<&SetJointMaxLimit::limit>("limit", "highest position", unit::JOINT));

struct SetJointFerror {
    int joint = 0;
    double ferror = 0;
};
template <>
inline constexpr auto DECLARED<SetJointFerror> =
    declare("SetJointFerror", 111, "sets the following error allowed at full speed",
            field<&SetJointFerror::joint>("joint", "number of the joint", unit::NONE, JOINTS),
            field<&SetJointFerror::ferror>("ferror", "allowed", unit::JOINT, AT_LEAST_0));

struct SetJointMinFerror {
    int joint = 0;
    double ferror = 0;
};
template <>
inline constexpr auto DECLARED<SetJointMinFerror> =
    declare("SetJointMinFerror", 115, "sets the following error allowed at low speed",
            field<&SetJointMinFerror::joint>("joint", "number of the joint", unit::NONE, JOINTS),
            field<&SetJointMinFerror::ferror>("ferror", "allowed", unit::JOINT, AT_LEAST_0));

struct SetJointBacklash {
    int joint = 0;
    double backlash = 0;
};
template <>
inline constexpr auto DECLARED<SetJointBacklash> =
    declare("SetJointBacklash", 134, "sets the backlash",
            field<&SetJointBacklash::joint>("joint", "number of the joint", unit::NONE, JOINTS),
            field<&SetJointBacklash::backlash>("backlash", "width", unit::JOINT));

struct SetJointHoming {
    int joint = 0;
    double home = 0;
    double offset = 0;
    double final_velocity = 0;
    double search_velocity = 0;
    double latch_velocity = 0;
    bool isIndexUsed = false;
    bool isEncoderReset = true;
    bool isLimitIgnored = false;
    bool isShared = false;
    int sequence = 0;
    bool isVolatile = false;
    bool isLocking = false;
    int absolute_encoder = 0;
};
template <>
inline constexpr auto DECLARED<SetJointHoming> = declare(
    "SetJointHoming", 112, "sets how a joint is homed",
    field<&SetJointHoming::joint>("joint", "number of the joint", unit::NONE, JOINTS),
    field<&SetJointHoming::home>("home", "position after homing", unit::JOINT),
    field<&SetJointHoming::offset>("offset", "of the switch or index", unit::JOINT),
    field<&SetJointHoming::final_velocity>("final_velocity", "of the last move; 0: rapid", unit::JOINT_SPEED),
    field<&SetJointHoming::search_velocity>(
        "search_velocity", "towards the switch; the sign is the direction", unit::JOINT_SPEED),
    field<&SetJointHoming::latch_velocity>(
        "latch_velocity", "off or onto the switch; the sign is the direction", unit::JOINT_SPEED),
    field<&SetJointHoming::isIndexUsed>("use_index", "the encoder index is the place"),
    field<&SetJointHoming::isEncoderReset>("encoder_reset", "the index resets the encoder"),
    field<&SetJointHoming::isLimitIgnored>("ignore_limits", "the limit switch is the home switch"),
    field<&SetJointHoming::isShared>("is_shared", "joints share a switch"),
    field<&SetJointHoming::sequence>("sequence", "place in home all; negative: together with others",
                                     unit::NONE, range(-1000, 1000)),
    field<&SetJointHoming::isVolatile>("volatile_home", "unhomed when the machine goes off"),
    field<&SetJointHoming::isLocking>("locking_indexer", "unlocked before it moves"),
    field<&SetJointHoming::absolute_encoder>("absolute_encoder", "0 none, 1 no move, 2 with a final move",
                                             unit::NONE, range(0, 2)));

struct EnableJoint {
    int joint = 0;
};
template <>
inline constexpr auto DECLARED<EnableJoint> =
    declare("EnableJoint", 121, "enables the amplifier of a joint",
            field<&EnableJoint::joint>("joint", "number of the joint", unit::NONE, JOINTS));

struct DisableJoint {
    int joint = 0;
};
template <>
inline constexpr auto DECLARED<DisableJoint> =
    declare("DisableJoint", 122, "disables the amplifier of a joint",
            field<&DisableJoint::joint>("joint", "number of the joint", unit::NONE, JOINTS));

struct ActivateJoint {
    int joint = 0;
};
template <>
inline constexpr auto DECLARED<ActivateJoint> =
    declare("ActivateJoint", 127, "lets a joint take part",
            field<&ActivateJoint::joint>("joint", "number of the joint", unit::NONE, JOINTS));

struct DeactivateJoint {
    int joint = 0;
};
template <>
inline constexpr auto DECLARED<DeactivateJoint> =
    declare("DeactivateJoint", 128, "leaves a joint out",
            field<&DeactivateJoint::joint>("joint", "number of the joint", unit::NONE, JOINTS));

struct LoadCompensation {
    int joint = 0;
    std::string path;
    int kind = 0;
};
template <>
inline constexpr auto DECLARED<LoadCompensation> =
    declare("LoadCompensation", 131, "loads a table of screw errors",
            field<&LoadCompensation::joint>("joint", "number of the joint", unit::NONE, JOINTS),
            field<&LoadCompensation::path>("path", "of the file", unit::NONE, range(1, 1023)),
            field<&LoadCompensation::kind>("kind", "0 nominal forward reverse, 1 nominal with trims",
                                           unit::NONE, range(0, 1)));

}  // namespace mw::messages

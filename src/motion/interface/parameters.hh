// SPDX-License-Identifier: GPL-2.0-or-later
// Declares every setting of the motion controller once: number, name, INI key, unit, range. A new setting is
// one row; SetParameter, the INI reader and the page docs/reference/ini.md use this table.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <string_view>

namespace mw::motion {

enum class ParameterScope : std::uint8_t { MACHINE, JOINT, AXIS, SPINDLE };
enum class ParameterUnit : std::uint8_t {
    NONE,
    LENGTH,
    SPEED,
    ACCELERATION,
    JERK,
    SECONDS,
    RPM,
    FLAG,
    COUNT
};

inline constexpr double UNBOUNDED = std::numeric_limits<double>::infinity();
/// A jerk limit of this value or more counts as none [unit/s^3].
inline constexpr double NO_JERK_LIMIT = 1e9;

// X(name, scope, INI section, INI key, unit, minimum, maximum, default, description). LENGTH, SPEED... are in
// the unit of the joint or axis (machine units or degrees).
#define MW_MOTION_PARAMETERS(X)                                                                              \
    X(TRAJ_MAX_VELOCITY, MACHINE, "TRAJ", "MAX_LINEAR_VELOCITY", SPEED, 0, UNBOUNDED, UNBOUNDED,             \
      "along the path")                                                                                      \
    X(TRAJ_MAX_ACCELERATION, MACHINE, "TRAJ", "MAX_LINEAR_ACCELERATION", ACCELERATION, 0, UNBOUNDED,         \
      UNBOUNDED, "along the path")                                                                           \
    X(TRAJ_MAX_JERK, MACHINE, "TRAJ", "MAX_LINEAR_JERK", JERK, 0, UNBOUNDED, NO_JERK_LIMIT,                  \
      "along the path; counts with PLANNER_TYPE = 1")                                                        \
    X(TRAJ_PLANNER_TYPE, MACHINE, "TRAJ", "PLANNER_TYPE", COUNT, 0, 1, 0, "1: motion keeps to jerk limits")  \
    X(TRAJ_CORNER_SCALE, MACHINE, "TRAJ", "SCURVE_PEAK_SCALE", NONE, 0.1, 1, 1,                              \
      "with jerk limits: part of the reachable speed in corners")                                            \
    X(TRAJ_ADDED_TOLERANCES, MACHINE, "TRAJ", "ADDED_TOLERANCES", FLAG, 0, 1, 0,                             \
      "accepted: the path stays within G64 P")                                                               \
    X(TRAJ_NO_PROBE_JOG_ERROR, MACHINE, "TRAJ", "NO_PROBE_JOG_ERROR", FLAG, 0, 1, 0,                         \
      "a probe that trips in a jog does not stop it")                                                        \
    X(TRAJ_NO_PROBE_HOME_ERROR, MACHINE, "TRAJ", "NO_PROBE_HOME_ERROR", FLAG, 0, 1, 0,                       \
      "a probe that trips while homing does not stop it")                                                    \
    X(TRAJ_MM_PER_UNIT, MACHINE, "", "", NONE, 1e-3, 1e6, 1, "millimetres of a machine unit")                \
    X(TRAJ_NO_FORCE_HOMING, MACHINE, "TRAJ", "NO_FORCE_HOMING", FLAG, 0, 1, 0,                               \
      "programs and MDI are taken before the joints are homed")                                              \
    X(MAX_FEED_SCALE, MACHINE, "DISPLAY", "MAX_FEED_OVERRIDE", NONE, 0, 1000, 1,                             \
      "maximum feed override; 1 is 100 %")                                                                   \
    X(JOINT_MIN_LIMIT, JOINT, "JOINT_*", "MIN_LIMIT", LENGTH, -UNBOUNDED, UNBOUNDED, -1e99,                  \
      "lower soft limit")                                                                                    \
    X(JOINT_MAX_LIMIT, JOINT, "JOINT_*", "MAX_LIMIT", LENGTH, -UNBOUNDED, UNBOUNDED, 1e99,                   \
      "upper soft limit")                                                                                    \
    X(JOINT_MAX_VELOCITY, JOINT, "JOINT_*", "MAX_VELOCITY", SPEED, 0, UNBOUNDED, 1, "of the joint")          \
    X(JOINT_MAX_ACCELERATION, JOINT, "JOINT_*", "MAX_ACCELERATION", ACCELERATION, 0, UNBOUNDED, 1,           \
      "of the joint")                                                                                        \
    X(JOINT_MAX_JERK, JOINT, "JOINT_*", "MAX_JERK", JERK, 0, UNBOUNDED, NO_JERK_LIMIT,                       \
      "of the joint; counts with PLANNER_TYPE = 1")                                                          \
    X(JOINT_FERROR, JOINT, "JOINT_*", "FERROR", LENGTH, 0, UNBOUNDED, 1,                                     \
      "following error allowed at MAX_VELOCITY")                                                             \
    X(JOINT_MIN_FERROR, JOINT, "JOINT_*", "MIN_FERROR", LENGTH, 0, UNBOUNDED, 1,                             \
      "following error allowed at rest")                                                                     \
    X(JOINT_BACKLASH, JOINT, "JOINT_*", "BACKLASH", LENGTH, 0, UNBOUNDED, 0,                                 \
      "play that is made up at each reversal")                                                               \
    X(JOINT_IS_ANGULAR, JOINT, "JOINT_*", "TYPE", FLAG, 0, 1, 0, "LINEAR or ANGULAR")                        \
    X(JOINT_HOME, JOINT, "JOINT_*", "HOME", LENGTH, -UNBOUNDED, UNBOUNDED, 0,                                \
      "where homing leaves the joint")                                                                       \
    X(JOINT_HOME_OFFSET, JOINT, "JOINT_*", "HOME_OFFSET", LENGTH, -UNBOUNDED, UNBOUNDED, 0,                  \
      "position of the home switch or index")                                                                \
    X(JOINT_HOME_SEARCH_VEL, JOINT, "JOINT_*", "HOME_SEARCH_VEL", SPEED, -UNBOUNDED, UNBOUNDED, 0,           \
      "towards the switch, with its sign; 0: no switch")                                                     \
    X(JOINT_HOME_LATCH_VEL, JOINT, "JOINT_*", "HOME_LATCH_VEL", SPEED, -UNBOUNDED, UNBOUNDED, 0,             \
      "at the edge that counts, with its sign")                                                              \
    X(JOINT_HOME_FINAL_VEL, JOINT, "JOINT_*", "HOME_FINAL_VEL", SPEED, -1, UNBOUNDED, -1,                    \
      "of the move to HOME; -1: MAX_VELOCITY")                                                               \
    X(JOINT_HOME_IGNORE_LIMITS, JOINT, "JOINT_*", "HOME_IGNORE_LIMITS", FLAG, 0, 1, 0,                       \
      "limit switches do not stop homing: one is the home switch")                                           \
    X(JOINT_HOME_USE_INDEX, JOINT, "JOINT_*", "HOME_USE_INDEX", FLAG, 0, 1, 0,                               \
      "the index pulse of the encoder counts")                                                               \
    X(JOINT_HOME_INDEX_NO_ENCODER_RESET, JOINT, "JOINT_*", "HOME_INDEX_NO_ENCODER_RESET", FLAG, 0, 1, 0,     \
      "the encoder keeps its count at the index")                                                            \
    X(JOINT_HOME_IS_SHARED, JOINT, "JOINT_*", "HOME_IS_SHARED", FLAG, 0, 1, 0,                               \
      "joints share the home switch")                                                                        \
    X(JOINT_HOME_ABSOLUTE_ENCODER, JOINT, "JOINT_*", "HOME_ABSOLUTE_ENCODER", COUNT, 0, 2, 0,                \
      "1: no homing move, 2: nor the final one")                                                             \
    X(JOINT_HOME_SEQUENCE, JOINT, "JOINT_*", "HOME_SEQUENCE", COUNT, -100, 1000, 1000,                       \
      "order of homing; equal ones together, negative ones end together")                                    \
    X(JOINT_VOLATILE_HOME, JOINT, "JOINT_*", "VOLATILE_HOME", FLAG, 0, 1, 0,                                 \
      "switching off unhomes the joint")                                                                     \
    X(JOINT_HOME_MAX_SKEW, JOINT, "JOINT_*", "HOME_MAX_SKEW", LENGTH, 0, UNBOUNDED, 0,                       \
      "how far apart joints of one axis may get while they home; 0: a hundredth of their range")             \
    X(JOINT_LOCKING_INDEXER, JOINT, "JOINT_*", "LOCKING_INDEXER", FLAG, 0, 1, 0,                             \
      "homing and jogs unlock the joint before and lock it afterwards; for programs see "                    \
      "[AXIS_l]LOCKING_INDEXER_JOINT")                                                                       \
    X(AXIS_MIN_LIMIT, AXIS, "AXIS_*", "MIN_LIMIT", LENGTH, -UNBOUNDED, UNBOUNDED, -1e99,                     \
      "lower soft limit; that of the joint where there is none")                                             \
    X(AXIS_MAX_LIMIT, AXIS, "AXIS_*", "MAX_LIMIT", LENGTH, -UNBOUNDED, UNBOUNDED, 1e99,                      \
      "upper soft limit; that of the joint where there is none")                                             \
    X(AXIS_MAX_VELOCITY, AXIS, "AXIS_*", "MAX_VELOCITY", SPEED, 0, UNBOUNDED, UNBOUNDED,                     \
      "of the axis; that of the joint where there is none")                                                  \
    X(AXIS_MAX_ACCELERATION, AXIS, "AXIS_*", "MAX_ACCELERATION", ACCELERATION, 0, UNBOUNDED, UNBOUNDED,      \
      "of the axis; that of the joint where there is none")                                                  \
    X(AXIS_MAX_JERK, AXIS, "AXIS_*", "MAX_JERK", JERK, 0, UNBOUNDED, NO_JERK_LIMIT,                          \
      "of the axis; counts with PLANNER_TYPE = 1")                                                           \
    X(AXIS_LOCKING_INDEXER_JOINT, AXIS, "", "", COUNT, -1, 15, -1,                                           \
      "joint whose lock holds the axis; -1: none")                                                           \
    X(AXIS_FIRST_PLACE, AXIS, "", "", LENGTH, -UNBOUNDED, UNBOUNDED, 0,                                      \
      "where forward kinematics that iterate look first")                                                    \
    X(AXIS_OFFSET_RATIO, AXIS, "AXIS_*", "OFFSET_AV_RATIO", NONE, 0, 0.9, 0,                                 \
      "part of velocity and acceleration that external offsets have; 0: there are none")                     \
    X(SPINDLE_MAX_FORWARD, SPINDLE, "SPINDLE_*", "MAX_FORWARD_VELOCITY", RPM, 0, UNBOUNDED, UNBOUNDED,       \
      "maximum speed of M3")                                                                                 \
    X(SPINDLE_MIN_FORWARD, SPINDLE, "SPINDLE_*", "MIN_FORWARD_VELOCITY", RPM, 0, UNBOUNDED, 0,               \
      "minimum speed of M3")                                                                                 \
    X(SPINDLE_MAX_REVERSE, SPINDLE, "SPINDLE_*", "MAX_REVERSE_VELOCITY", RPM, 0, UNBOUNDED, UNBOUNDED,       \
      "maximum speed of M4; 0: it does not turn in reverse; that of M3 where it is not set")                 \
    X(SPINDLE_MIN_REVERSE, SPINDLE, "SPINDLE_*", "MIN_REVERSE_VELOCITY", RPM, 0, UNBOUNDED, 0,               \
      "minimum speed of M4; that of M3 where it is not set")                                                 \
    X(SPINDLE_RAMP, SPINDLE, "SPINDLE_*", "RAMP", NONE, 0, UNBOUNDED, 0,                                     \
      "change of speed [rev/min each second] at which the spindle reverses; rigid tapping uses it; "         \
      "0: measured at each reversal")

enum class Parameter : std::uint16_t {
#define MW_X(name, scope, section, key, unit, low, high, preset, doc) name,
    MW_MOTION_PARAMETERS(MW_X)
#undef MW_X
        COUNT
};

struct ParameterInfo {
    Parameter parameter;
    std::string_view name;
    ParameterScope scope;
    std::string_view ini_section;  ///< "JOINT_*" for JOINT_0 and so on; empty: no key
    std::string_view ini_key;
    ParameterUnit unit;
    double lowest, highest, preset;
    std::string_view doc;
};

inline constexpr std::array PARAMETERS = {
#define MW_X(name, scope, section, key, unit, low, high, preset, doc)                                        \
    ParameterInfo{                                                                                           \
        Parameter::name, #name, ParameterScope::scope, section, key, ParameterUnit::unit, low, high,         \
        preset,          doc},
    MW_MOTION_PARAMETERS(MW_X)
#undef MW_X
};

}  // namespace mw::motion

// SPDX-License-Identifier: GPL-2.0-or-later
// The plan of a seed: a machine, the actions of its operator, and the faults that occur.
#pragma once

#include <cstdint>
#include <set>
#include <string>
#include <vector>

#include "base/geometry/move_settings.hh"
#include "base/geometry/pose.hh"
#include "campaign/design.hh"

namespace mw::campaign {

/// Expected result of a probing move.
struct ProbeMove {
    int axis = -1;       ///< axis of the move; -1: no probing move
    bool isMet = false;  ///< the move reaches or leaves a contact
    double wall = 0;     ///< position of the contact
    double speed = 0;    ///< [unit/s]
};

/// The probe has contact outside this range.
struct Contact {
    int axis = 0;
    double low = 0, high = 0;
};

/// Spindle-synchronized motion of a program.
enum class Sync {
    NONE,
    THREAD,    ///< passes of one helix: G33, G76
    TAP,       ///< G33.1
    PER_TURN,  ///< G95
    SURFACE,   ///< G96 while X moves
};
struct SyncWish {
    Sync kind = Sync::NONE;
    double lead = 0;          ///< [unit/turn]; SURFACE: [m/min]
    double from = 0, to = 0;  ///< along Z; for SURFACE along X
    double rpm = 0;           ///< with its sign; SURFACE: the maximum
    int passes = 0;           ///< minimum
    bool isShort = false;     ///< too short to reach its speed
};

/// A line of a program with its path in machine coordinates.
struct Block {
    std::string text;
    bool isMove = false, isArc = false;
    bool isTimed = true;  ///< its duration can be estimated
    geometry::Pose end, centre;
    double angle_rad = 0;  ///< rotation about +Z
    double dwell_s = 0;
    geometry::MoveSettings settings;
    ProbeMove probe;
};

enum class Work { PROGRAM, JOG_JOINT, JOG_AXIS, HOME, PROBE, SPINDLE, WHEEL };
/// True for work that runs a program.
constexpr bool isProgram(Work work) {
    return work == Work::PROGRAM || work == Work::PROBE || work == Work::SPINDLE;
}

enum class Upset {
    ABORT,          ///< an operator's stop
    OFF,            ///< machine off by command, as at an exit
    ESTOP_COMMAND,  ///< e-stop by command
    ESTOP,          ///< the chain opens
    ENABLE,         ///< pin motion.enable
    AMP_FAULT,
    LIMIT_SWITCH,
    ENCODER_LOST,
    ENCODER_JUMP,
    ENCODER_NAN,
    SPINDLE_FAULT,
    PROBE_STUCK,  ///< the contact closes in a move that does not probe
    TASK_HUNG,    ///< longer than the timeout of the watchdog
    TASK_DEAD,    ///< the process has ended
    // --- the work continues after these
    PAUSE,
    SPINDLE_NAN,  ///< measured speed and revolutions, while no motion is synchronized to the spindle
    FEED_OVERRIDE,
    RAPID_OVERRIDE,
    FEED_INHIBIT,
    ADAPTIVE_NAN,    ///< pin motion.adaptive-feed; M52 is off
    PLANNER_LATE,    ///< a few periods
    PLANNER_LOST,    ///< a second
    WRONG_COMMANDS,  ///< modes, jogs and runs that the current state rejects
    // --- not in the first plan
    OFFSET,    ///< external offset of an axis
    ADAPTIVE,  ///< feed, -1 to 1
    SPINDLE_OVERRIDE,
};
inline constexpr int UPSET_COUNT = static_cast<int>(Upset::SPINDLE_OVERRIDE) + 1;
const char *name_of(Upset upset);
/// True if the work continues after the fault.
constexpr bool isPassing(Upset upset) {
    return upset >= Upset::PAUSE;
}

struct Trouble {
    Upset what = Upset::ABORT;
    int at_ms = 0;  ///< after the start of the work
    int length_ms = 100;
    int joint = 0;
    double value = 0;
};

/// Motion of a jog wheel.
struct Turning {
    bool isJoint = true;
    double scale = 0;            ///< distance of a count [units]
    int counts_per_cycle = 0;    ///< signed
    int cycles = 0, pause = 10;  ///< duration and interval of the counts [cycles]
    bool isVelocityMode = false;
    double accel_fraction = 1;
};

struct Act {
    Work work = Work::PROGRAM;
    std::vector<Block> blocks;
    bool isTimed = true;    ///< its duration can be estimated
    bool isToFail = false;  ///< a program that must fail
    bool mayFail = false;   ///< may be rejected; blocks that run must be correct
    std::vector<Contact> contacts;
    SyncWish sync;
    int target = 0;       ///< joint or axis
    double distance = 0;  ///< 0: continuous
    double velocity = 0;
    int length_ms = 500;  ///< of a continuous jog
    int lease_ms = 0;     ///< lease of a jog whose client ends without a stop; 0: none
    Turning turning;
    std::vector<Trouble> troubles;
};

struct Plan {
    std::uint64_t seed = 0;
    Design design;
    double least_s = 1e300;  ///< machine time after which the last act is next
    std::vector<Act> acts;
};

bool hasTrouble(const Act &act, Upset what);

/// Version of the plans. 1: sessions of a minute. 4: further kinematics, and taps on machines whose joints
/// are not axes. 5: as 3, and the planner does not run for some time after the start of each stop. 2 is not
/// used.
inline constexpr unsigned PLAN_VERSION = 3, PLANNER_LOST_PLAN = 5, LAST_PLAN = 5;
Plan make_plan(std::uint64_t seed, unsigned version = PLAN_VERSION);

/// The parts of a plan that `kept` selects (syntax: campaign_runner/kept.hh). Only moves can be removed from
/// blocks.
Plan reduced(const Plan &plan, const std::string &kept);

}  // namespace mw::campaign

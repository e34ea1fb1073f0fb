// SPDX-License-Identifier: GPL-2.0-or-later
// What a seed stands for: a machine, what its operator does with it, and what goes wrong meanwhile.
#pragma once

#include <cstdint>
#include <set>
#include <string>
#include <vector>

#include "base/geometry/move_settings.hh"
#include "base/geometry/pose.hh"
#include "campaign/design.hh"

namespace mw::campaign {

/// What is known of a probing move before it is made.
struct ProbeMove {
    int axis = -1;       ///< along which it goes; -1: no probing move
    bool isMet = false;  ///< there is a contact to find, or to leave, on its way
    double wall = 0;     ///< where
    double speed = 0;    ///< [unit/s]
};

/// Outside of this room the probe has contact.
struct Contact {
    int axis = 0;
    double low = 0, high = 0;
};

/// What a program does in step with the spindle.
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
    double from = 0, to = 0;  ///< along Z; SURFACE: along X
    double rpm = 0;           ///< with its sign; SURFACE: the most
    int passes = 0;           ///< at least
    bool isShort = false;     ///< too short to come to its speed
};

/// A line of a program with the path that it asks for, in machine coordinates.
struct Block {
    std::string text;
    bool isMove = false, isArc = false;
    bool isTimed = true;  ///< the time that it takes can be estimated
    geometry::Pose end, centre;
    double angle_rad = 0;  ///< about +Z
    double dwell_s = 0;
    geometry::MoveSettings settings;
    ProbeMove probe;
};

enum class Work { PROGRAM, JOG_JOINT, JOG_AXIS, HOME, PROBE, SPINDLE, WHEEL };
/// A program is run.
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
    TASK_HUNG,    ///< longer than the watchdog's time
    TASK_DEAD,    ///< by the kernel's word, for good
    // --- after these the work goes on
    PAUSE,
    SPINDLE_NAN,  ///< measured speed and turns, of a spindle that nothing is in step with
    FEED_OVERRIDE,
    RAPID_OVERRIDE,
    FEED_INHIBIT,
    ADAPTIVE_NAN,    ///< pin motion.adaptive-feed; M52 is off
    PLANNER_LATE,    ///< a few periods
    PLANNER_LOST,    ///< a second
    WRONG_COMMANDS,  ///< modes, jogs and runs that do not fit what is under way
    // --- not in the first plan
    OFFSET,    ///< external, of an axis
    ADAPTIVE,  ///< feed, -1 to 1
    SPINDLE_OVERRIDE,
};
inline constexpr int UPSET_COUNT = static_cast<int>(Upset::SPINDLE_OVERRIDE) + 1;
const char *name_of(Upset upset);
/// The work goes on after it.
constexpr bool isPassing(Upset upset) {
    return upset >= Upset::PAUSE;
}

struct Trouble {
    Upset what = Upset::ABORT;
    int at_ms = 0;  ///< after the work has begun
    int length_ms = 100;
    int joint = 0;
    double value = 0;
};

/// How somebody turns a wheel.
struct Turning {
    bool isJoint = true;
    double scale = 0;            ///< of a count [units]
    int counts_per_cycle = 0;    ///< with its sign
    int cycles = 0, pause = 10;  ///< counts come for so long, every so many cycles
    bool isVelocityMode = false;
    double accel_fraction = 1;
};

struct Act {
    Work work = Work::PROGRAM;
    std::vector<Block> blocks;
    bool isTimed = true;    ///< the time that it takes can be estimated
    bool isToFail = false;  ///< a program that must not come to its end
    bool mayFail = false;   ///< may be refused; what is made is right all the same
    std::vector<Contact> contacts;
    SyncWish sync;
    int target = 0;       ///< joint or axis
    double distance = 0;  ///< 0: continuous
    double velocity = 0;
    int length_ms = 500;  ///< of a continuous jog
    int lease_ms = 0;     ///< of it: whoever jogs goes without a stop; 0: none
    Turning turning;
    std::vector<Trouble> troubles;
};

struct Plan {
    std::uint64_t seed = 0;
    Design design;
    double least_s = 1e300;  ///< of machine time: once it has passed the last act comes next
    std::vector<Act> acts;
};

bool hasTrouble(const Act &act, Upset what);

/// Of what a seed stands for; 1: as it was first, sessions of a minute; there is no 2 any more. 4: further
/// kinematics, and taps where joints are not axes. 5: as 3, with the planner lost as each stop begins and for
/// a while.
inline constexpr unsigned PLAN_VERSION = 3, PLANNER_LOST_PLAN = 5, LAST_PLAN = 5;
Plan make_plan(std::uint64_t seed, unsigned version = PLAN_VERSION);

/// What is kept of a plan, in the words of campaign_runner/kept.hh; of blocks, moves alone are left out.
Plan reduced(const Plan &plan, const std::string &kept);

}  // namespace mw::campaign

// SPDX-License-Identifier: GPL-2.0-or-later
// The plan of a seed: the machine, the actions of its operators, and the faults during them.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "task_campaign/facts.hh"

namespace mw::task_campaign {

inline constexpr unsigned PLAN_VERSION = 1;
inline constexpr int CLIENTS = 4;

enum class Work {
    PROGRAM,
    FROM_LINE,
    MDI,
    SWITCHES,  ///< optional stop, block delete, overrides
    BY_HAND,   ///< spindle and coolant in manual mode
    JOG,
    HOME,
    TABLE,    ///< a tool is set, the table is written by another program and read again
    STATE,    ///< off, emergency stop, and on again
    ODD,      ///< commands that may be valid or not
    OPERATE,  ///< one client operates alone
    CRASH,    ///< of the whole machine, stopped
};

enum class Upset {
    // --- the work continues after these
    PAUSE,
    STEP,
    LEAVE,
    OVERRIDE,
    ODD,
    CLIENT_GONE,
    // --- the work ends after these
    ABORT,
    OFF,
    ESTOP,
    CHAIN,
    CHANGER_FAULT,
    RESET_INTERPRETER,
    KILLED,     ///< as by kill -9: data passed to the disk are kept
    POWER_CUT,  ///< unsynced data are lost
};
inline constexpr int UPSET_COUNT = static_cast<int>(Upset::POWER_CUT) + 1;
const char *name_of(Upset upset);
const char *name_of(Work work);
constexpr bool isEnding(Upset upset) {
    return upset >= Upset::ABORT;
}

struct Trouble {
    Upset what = Upset::PAUSE;
    int at_ms = 0, length_ms = 50;
    int client = 0;
    std::uint64_t seed = 0;  ///< chosen by itself
};

struct Act {
    Work work = Work::PROGRAM;
    int client = 0;
    std::vector<Line> blocks;      ///< blocks of the program, or MDI lines
    bool isLineTypedLate = false;  ///< an MDI line is entered after the previous line has ended
    std::uint64_t seed = 0;
    std::vector<Trouble> troubles;
};

struct Plan {
    std::uint64_t seed = 0;
    bool isRandomChanger = false;
    int changer_ms = 20;  ///< the answer follows after this time
    std::vector<Tool> tools;
    std::vector<Act> acts;
};

Plan make_plan(std::uint64_t seed);
/// In the syntax of campaign_runner/kept.hh.
Plan reduced(const Plan &plan, const std::string &kept);

}  // namespace mw::task_campaign

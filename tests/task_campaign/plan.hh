// SPDX-License-Identifier: GPL-2.0-or-later
// From a seed: the machine, what its operators do, and what goes wrong meanwhile.
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
    ODD,      ///< commands that may fit or not
    OPERATE,  ///< one client operates alone
    CRASH,    ///< of the whole machine, at rest
};

enum class Upset {
    // --- the work continues after these
    PAUSE,
    STEP,
    LEAVE,
    OVERRIDE,
    ODD,
    CLIENT_GONE,
    // --- these end it
    ABORT,
    OFF,
    ESTOP,
    CHAIN,
    CHANGER_FAULT,
    RESET_INTERPRETER,
    KILLED,     ///< as by kill -9: what was given to the disk is there
    POWER_CUT,  ///< what was not synced is lost
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
    std::uint64_t seed = 0;  ///< of what it chooses by itself
};

struct Act {
    Work work = Work::PROGRAM;
    int client = 0;
    std::vector<Line> blocks;      ///< of the program; lines of MDI
    bool isLineTypedLate = false;  ///< lines of MDI come one after the other
    std::uint64_t seed = 0;
    std::vector<Trouble> troubles;
};

struct Plan {
    std::uint64_t seed = 0;
    bool isRandomChanger = false;
    int changer_ms = 20;  ///< it answers after so long
    std::vector<Tool> tools;
    std::vector<Act> acts;
};

Plan make_plan(std::uint64_t seed);
/// In the words of campaign_runner/kept.hh.
Plan reduced(const Plan &plan, const std::string &kept);

}  // namespace mw::task_campaign

// SPDX-License-Identifier: GPL-2.0-or-later
// Compares the homing table with docs/integrator/homing.md, and tests every event in every state.
#include <algorithm>
#include <array>
#include <cstdint>
#include <fstream>
#include <functional>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "motion/servo/homing/homing_drive.hh"

namespace mw::motion {
namespace {

using homing::Action;
using homing::Failure;
using homing::State;
namespace event = homing::event;
namespace setting = homing::setting;

std::string word(State state) {
    switch (state) {
    case State::IDLE: return "IDLE";
    case State::UNLOCK: return "UNLOCK";
    case State::START: return "START";
    case State::INITIAL_BACKOFF: return "INITIAL_BACKOFF";
    case State::INITIAL_BACKOFF_STOP: return "INITIAL_BACKOFF_STOP";
    case State::SEARCH: return "SEARCH";
    case State::SEARCH_STOP: return "SEARCH_STOP";
    case State::LATCH_BACKOFF: return "LATCH_BACKOFF";
    case State::LATCH_BACKOFF_STOP: return "LATCH_BACKOFF_STOP";
    case State::LATCH: return "LATCH";
    case State::INDEX: return "INDEX";
    case State::LATCHED: return "LATCHED";
    case State::LATCHED_STOP: return "LATCHED_STOP";
    case State::WAIT_FOR_GROUP: return "WAIT_FOR_GROUP";
    case State::FINAL: return "FINAL";
    case State::LOCK: return "LOCK";
    case State::COUNT: return "any but IDLE";
    }
    return "?";
}

std::string word(Failure failure) {
    switch (failure) {
    case Failure::NONE: return "";
    case Failure::SEARCH_WITHOUT_LATCH: return "search without latch";
    case Failure::LATCH_WITHOUT_INDEX: return "latch without index";
    case Failure::INDEX_WITHOUT_LATCH: return "index without latch";
    case Failure::SHARED_SWITCH_CLOSED: return "shared switch closed";
    case Failure::SWITCH_NOT_FOUND: return "switch not found";
    case Failure::SWITCH_STUCK: return "switch stuck";
    case Failure::SWITCH_LOST: return "switch lost";
    case Failure::SWITCH_CLOSED_AGAIN: return "switch closed again";
    case Failure::INDEX_NOT_FOUND: return "index not found";
    case Failure::LIMIT_HIT: return "limit hit";
    case Failure::ABORTED: return "aborted";
    case Failure::TEAM_DIFFERS: return "team differs";
    case Failure::TEAM_SKEWED: return "team skewed";
    case Failure::NOT_UNLOCKED: return "not unlocked";
    case Failure::NOT_LOCKED: return "not locked";
    case Failure::INHIBITED: return "inhibited";
    case Failure::MODULE_FAILED: return "module failed";
    case Failure::MODULE_NONSENSE: return "module nonsense";
    }
    return "?";
}

std::string word(Action action) {
    switch (action) {
    case Action::NOTHING: return "";
    case Action::STOP: return "stops";
    case Action::UNLOCK: return "requests unlocking";
    case Action::SET_PLACE: return "sets its position to HOME_OFFSET";
    case Action::SET_PLACE_STOP: return "sets its position to HOME_OFFSET, stops";
    case Action::SEARCH: return "moves at HOME_SEARCH_VEL";
    case Action::BACK_OFF: return "moves at HOME_SEARCH_VEL in reverse";
    case Action::LATCH: return "moves at HOME_LATCH_VEL";
    case Action::ASK_INDEX: return "requests the index";
    case Action::LATCH_ASK_INDEX: return "requests the index, moves at HOME_LATCH_VEL";
    case Action::TAKE_INDEX: return "sets the index position to HOME_OFFSET";
    case Action::TAKE_INDEX_STOP: return "sets the index position to HOME_OFFSET, stops";
    case Action::GO_HOME: return "moves to HOME at HOME_FINAL_VEL";
    }
    return "?";
}

using Words = std::vector<std::pair<std::uint32_t, const char *>>;

const Words EVENTS = {
    {event::BEGIN, "homing requested"},
    {event::TEAM_SETTLED, "joint and team stopped and settled"},
    {event::TEAM_AT_REST, "joint and team stopped"},
    {event::AT_REST, "joint stopped"},
    {event::SWITCH_CLOSED, "switch closed"},
    {event::SWITCH_OPEN, "switch open"},
    {event::TEAM_CLOSED, "a switch of the team closed"},
    {event::TEAM_OPEN, "all switches of the team open"},
    {event::INDEX, "index pulse"},
    {event::TEAM_LATCHED, "the team has latched"},
    {event::GROUP_READY, "the group is ready"},
    {event::TEAM_UNLOCKED, "the team is unlocked"},
    {event::LOCKED, "locked"},
    {event::OVERDUE, "after 30 s"},
    {event::TEAM_DIFFERS, "the team has other homing settings"},
    {event::TEAM_SKEWED, "the skew of the team would exceed its limit"},
    {event::LIMIT, "limit switch"},
    {event::ABORT, "abort"},
    {event::OFF, "machine off"},
    {event::MEMBER_FAILED, "another joint fails"},
};

const Words SETTINGS = {
    {setting::SEARCHING, "HOME_SEARCH_VEL"},
    {setting::LATCHING, "HOME_LATCH_VEL"},
    {setting::INDEX, "HOME_USE_INDEX"},
    {setting::SAME_WAY, "velocities of one sign"},
    {setting::SHARED, "HOME_IS_SHARED"},
    {setting::ABSOLUTE, "HOME_ABSOLUTE_ENCODER"},
    {setting::STAYING, "HOME_ABSOLUTE_ENCODER = 2"},
    {setting::LOCKING, "LOCKING_INDEXER"},
    {setting::TEAM, "a team"},
};

std::string listed(std::uint32_t bits, const Words &words, const std::string &before = "") {
    std::string out;
    for (const auto &[bit, name] : words) {
        out += (bits & bit) != 0 ? (out.empty() ? "" : ", ") + before + name : "";
    }
    return out;
}

std::string made_table() {
    std::string out = "| state | event | setting | action | next state |\n|---|---|---|---|---|\n";
    for (const homing::Transition &row : homing::TRANSITIONS) {
        const std::string with = listed(row.when, SETTINGS);
        const std::string without = listed(row.unless, SETTINGS, "no ");
        const std::string next = row.failure != Failure::NONE ? "IDLE: " + word(row.failure)
                                 : row.isHomed                ? "IDLE, homed"
                                                              : word(row.next);
        out += "| " + word(row.state) + " | " + (row.events == 0 ? "at once" : listed(row.events, EVENTS)) +
               " | " + with + (with.empty() || without.empty() ? "" : ", ") + without + " | " +
               word(row.action) + " | " + next + " |\n";
    }
    return out;
}

/// Joint 0 is driven through the states; joint 1 homes in the same sequence.
struct Walk {
    homing::Homing own;
    HomingDrive drive{1e-3, &own};
    Settings settings;
    homing::JointInput inputs[MAX_JOINTS];
    homing::JointCommand commands[MAX_JOINTS];
    bool hasStopped = false;

    explicit Walk(State target) {
        drive.use_joints(2, 2);
        const bool isTeam = target == State::LATCHED;
        const bool isOtherReady = target == State::FINAL || target == State::LOCK;
        for (int j = 0; j < 2; ++j) {
            homing::Parameters &p = own.parameters(j);
            p.search_vel = j == 1 && isOtherReady ? 0 : -10;
            p.latch_vel = p.search_vel / 5;
            p.isUsingIndex = p.search_vel != 0 && (j == 0 || isTeam);
            p.isLockingIndexer = j == 0 || isTeam;
            p.sequence = -1;
            p.travel = 1e9;
            p.axis = isTeam ? 0 : j;
            inputs[j].isAtRest = false;
            inputs[j].max_velocity = 50;
            inputs[j].max_acceleration = 500;
        }
    }
    State state() const { return own.state(0); }
    void step() {
        for (int j = 0; j < 2; ++j) {
            inputs[j].isIndexEnabled = own.isIndexWanted(j);
        }
        step_as_is();
    }
    void step_as_is() {
        own.step(inputs, commands);
        hasStopped = hasStopped || commands[0].move == homing::Move::STOP;
    }
    /// Sets inputs of `state` without events.
    void be_quiet(State state) {
        constexpr std::array CLOSED = {State::INITIAL_BACKOFF, State::SEARCH_STOP, State::LATCH_BACKOFF,
                                       State::INDEX,           State::LATCHED,     State::LATCHED_STOP};
        inputs[0].isSwitchClosed = std::find(CLOSED.begin(), CLOSED.end(), state) != CLOSED.end();
        inputs[0].isAtRest = state == State::IDLE || state == State::UNLOCK || state == State::START ||
                             state == State::WAIT_FOR_GROUP;
        inputs[0].isUnlocked = state != State::IDLE && state != State::UNLOCK;
        inputs[1].isUnlocked = inputs[0].isUnlocked;
        // The other joint searches, or does the same up to the latch.
        if (own.parameters(1).axis == 0 && state != State::INDEX && state != State::LATCHED) {
            inputs[1] = inputs[0];
        }
    }
    /// Sends the event that leads to the next state.
    void lead_on(State state) {
        inputs[0].isAtRest = true;
        inputs[0].isSwitchClosed = state == State::START || state == State::SEARCH ||
                                   state == State::SEARCH_STOP || state == State::LATCH;
        inputs[0].isUnlocked = state != State::LOCK;
        const bool isTogether = own.parameters(1).axis == 0 && state != State::LATCH;
        if (isTogether && state != State::INDEX) {
            inputs[1] = inputs[0];
        }
        inputs[0].isIndexEnabled = false;
        inputs[1].isIndexEnabled = own.isIndexWanted(1);
        step_while_in(state);
    }
    /// Steps long enough for contacts to settle.
    void step_while_in(State state) {
        constexpr int CYCLES = 25;
        for (int n = 0; n < CYCLES && own.state(0) == state; ++n) {
            step_as_is();
        }
    }
    bool reach(State target) {
        be_quiet(State::IDLE);
        if (target == State::IDLE) {
            return true;
        }
        own.start(0);
        for (int n = 0; n < 20 && state() != target && state() != State::IDLE; ++n) {
            be_quiet(state());
            lead_on(state());
        }
        be_quiet(state());
        return state() == target;
    }
};

struct WalkedEvent {
    const char *name;
    std::function<void(Walk &)> happen;
};

void look(Walk &w) {
    w.step();
}

const std::vector<WalkedEvent> WALKED = {
    {"nothing", look},
    {"switch closed",
     [](Walk &w) {
         w.inputs[0].isSwitchClosed = true;
         w.step();
     }},
    {"switch open",
     [](Walk &w) {
         w.inputs[0].isSwitchClosed = false;
         w.step();
     }},
    {"index",
     [](Walk &w) {
         w.inputs[1].isIndexEnabled = w.own.isIndexWanted(1);
         w.inputs[0].isIndexEnabled = false;
         w.step_as_is();
     }},
    {"stopped",
     [](Walk &w) {
         w.inputs[0].isAtRest = true;
         w.inputs[0].isIndexEnabled = w.own.isIndexWanted(0);
         w.inputs[1].isIndexEnabled = w.own.isIndexWanted(1);
         w.step_while_in(w.state());
     }},
    {"unlocked",
     [](Walk &w) {
         w.inputs[0].isUnlocked = true;
         w.step();
     }},
    {"locked",
     [](Walk &w) {
         w.inputs[0].isUnlocked = false;
         w.step();
     }},
    {"after 30 s",
     [](Walk &w) {
         const State from = w.state();
         for (int n = 0; n < 30010 && w.state() == from; ++n) {
             w.step();
         }
     }},
    {"limit",
     [](Walk &w) {
         w.drive.abort(event::LIMIT, 0);
         w.step();
     }},
    {"abort",
     [](Walk &w) {
         w.drive.abort(event::ABORT);
         w.step();
     }},
    {"off",
     [](Walk &w) {
         w.drive.switch_off(w.settings);
         w.step();
     }},
    {"inhibit",
     [](Walk &w) {
         HomeConditions conditions;
         conditions.isReady = true;
         conditions.isInhibited = true;
         EXPECT_NE(w.drive.take(Home{0}, conditions).reason, Reason::NONE);
         w.step();
     }},
    {"another fails",
     [](Walk &w) {
         w.drive.abort(event::LIMIT, 1);
         w.step();
     }},
};

std::string outcome(State from, const WalkedEvent &what) {
    Walk w(from);
    if (!w.reach(from)) {
        ADD_FAILURE() << "no way to " << word(from) << ", but to " << word(w.state());
        return "?";
    }
    w.hasStopped = false;
    what.happen(w);
    Failure why{};
    const int joint = w.own.take_failure(why);
    const State next = w.state();
    const bool isEnd = joint >= 0 && from != State::IDLE;
    if (isEnd) {
        EXPECT_EQ(next, State::IDLE);
        EXPECT_TRUE(w.hasStopped) << word(from) << ' ' << what.name;
        EXPECT_FALSE(w.own.isHomed(0) || w.own.isActive() || w.own.isIndexWanted(0));
        return joint == 0 ? "**" + word(why) + "**" : "stops";
    }
    if (w.own.isHomed(0)) {
        return "homed";
    }
    return next == from ? "" : word(next);
}

std::string made_matrix() {
    std::string out = "| state |";
    std::string line = "|---|";
    for (const WalkedEvent &e : WALKED) {
        out += std::string(" ") + e.name + " |";
        line += "---|";
    }
    out += "\n" + line + "\n";
    for (int s = 0; s < static_cast<int>(State::COUNT); ++s) {
        out += "| " + word(static_cast<State>(s)) + " |";
        for (const WalkedEvent &e : WALKED) {
            const std::string cell = outcome(static_cast<State>(s), e);
            out += cell.empty() ? " |" : " " + cell + " |";
        }
        out += "\n";
    }
    return out;
}

std::string page() {
    std::ifstream in(MW_SOURCE_DIR "/docs/integrator/homing.md");
    return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

TEST(HomingTable, ThePageShowsTheTable) {
    const std::string made = made_table();
    EXPECT_NE(page().find("\n" + made), std::string::npos) << "docs/integrator/homing.md is to have:\n"
                                                           << made;
}

TEST(HomingTable, EveryEventInEveryStateActsAsThePageDocuments) {
    const std::string made = made_matrix();
    EXPECT_NE(page().find("\n" + made), std::string::npos) << "docs/integrator/homing.md is to have:\n"
                                                           << made;
}

}  // namespace
}  // namespace mw::motion

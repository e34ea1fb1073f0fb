// SPDX-License-Identifier: GPL-2.0-or-later
// Homing of a joint as one table: the next state for each event in each state. docs/integrator/homing.md
// prints the table.
#pragma once

#include <cstdint>

namespace mw::homing {

enum class State : std::uint8_t {
    IDLE,
    UNLOCK,  ///< requests a locking indexer to unlock
    START,
    INITIAL_BACKOFF,  ///< moves off a switch that was closed at the start
    INITIAL_BACKOFF_STOP,
    SEARCH,  ///< towards the switch
    SEARCH_STOP,
    LATCH_BACKOFF,  ///< moves off the switch to approach it slowly
    LATCH_BACKOFF_STOP,
    LATCH,    ///< moves slowly to the edge of the switch
    INDEX,    ///< moves slowly to the index pulse
    LATCHED,  ///< has its zero; moves with its team until each joint of the team has its zero
    LATCHED_STOP,
    WAIT_FOR_GROUP,  ///< waits until all synchronised joints are ready for the final move
    FINAL,
    LOCK,  ///< requests a locking indexer to lock
    COUNT,
};
/// In the table, a row with it applies to every state except IDLE.
inline constexpr State UNDER_WAY = State::COUNT;

enum class Failure : std::uint8_t {
    NONE,
    SEARCH_WITHOUT_LATCH,  ///< HOME_SEARCH_VEL is set, HOME_LATCH_VEL is 0
    LATCH_WITHOUT_INDEX,   ///< HOME_LATCH_VEL is set without a search velocity and without index
    INDEX_WITHOUT_LATCH,   ///< HOME_USE_INDEX is set, HOME_LATCH_VEL is 0
    SHARED_SWITCH_CLOSED,
    SWITCH_NOT_FOUND,
    SWITCH_STUCK,         ///< backing off did not open the switch
    SWITCH_LOST,          ///< found, but open after the stop
    SWITCH_CLOSED_AGAIN,  ///< left, but closed again after the stop
    INDEX_NOT_FOUND,
    LIMIT_HIT,
    ABORTED,
    TEAM_DIFFERS,  ///< joints of one axis have different homing settings
    TEAM_SKEWED,   ///< the difference between them would exceed the maximum
    NOT_UNLOCKED,
    NOT_LOCKED,
    INHIBITED,        ///< inhibited after the command and before the start
    MODULE_FAILED,    ///< a user's module has reported a failure
    MODULE_NONSENSE,  ///< a module commanded a value that is not a finite number
};

/// Events of a cycle, as bits. A joint without a team counts as its own team.
namespace event {
enum Event : std::uint32_t {
    BEGIN = 1U << 0,
    SWITCH_CLOSED = 1U << 1,
    SWITCH_OPEN = 1U << 2,
    TEAM_CLOSED = 1U << 3,  ///< a switch of the team is closed
    TEAM_OPEN = 1U << 4,    ///< all switches of the team are open
    INDEX = 1U << 5,
    AT_REST = 1U << 6,
    TEAM_AT_REST = 1U << 7,  ///< all joints of the team are stopped in one state
    TEAM_LATCHED = 1U << 8,
    GROUP_READY = 1U << 9,     ///< all joints that end together have found their zero
    TEAM_UNLOCKED = 1U << 10,  ///< all indexers of the team are unlocked
    LOCKED = 1U << 11,
    OVERDUE = 1U << 12,  ///< waited too long
    TEAM_DIFFERS = 1U << 13,
    TEAM_SKEWED = 1U << 14,
    LIMIT = 1U << 15,  ///< a limit switch that is not ignored has closed
    ABORT = 1U << 16,
    OFF = 1U << 17,
    MEMBER_FAILED = 1U << 18,  ///< another joint that is being homed has failed
    TEAM_SETTLED = 1U << 19,   ///< TEAM_AT_REST, and no contact bounces
};
}

/// Settings of a joint, as bits.
namespace setting {
enum Setting : std::uint32_t {
    SEARCHING = 1U << 0,  ///< HOME_SEARCH_VEL is not 0
    LATCHING = 1U << 1,   ///< HOME_LATCH_VEL is not 0
    INDEX = 1U << 2,
    SAME_WAY =
        1U
        << 3,  ///< both velocities have the same sign: the closing edge is used, otherwise the opening edge
    SHARED = 1U << 4,
    ABSOLUTE = 1U << 5,
    STAYING = 1U << 6,  ///< HOME_ABSOLUTE_ENCODER = 2
    LOCKING = 1U << 7,
    TEAM = 1U << 8,  ///< moves one axis with other joints
};
}

enum class Action : std::uint8_t {
    NOTHING,
    STOP,
    UNLOCK,
    SET_PLACE,       ///< the current position becomes HOME_OFFSET
    SET_PLACE_STOP,  ///< the same, and stop
    SEARCH,
    BACK_OFF,
    LATCH,
    ASK_INDEX,
    LATCH_ASK_INDEX,
    TAKE_INDEX,  ///< the position of the index pulse becomes HOME_OFFSET
    TAKE_INDEX_STOP,
    GO_HOME,
};

struct Transition {
    State state;
    std::uint32_t events;        ///< all of these events; 0: at once
    std::uint32_t when, unless;  ///< all of these settings, and none of those
    Action action = Action::NOTHING;
    State next = State::IDLE;
    Failure failure = Failure::NONE;  ///< the next state is IDLE, and all joints that are homing stop
    bool isHomed = false;             ///< the joint is homed from this state on
};

/// The first matching row is used, one per cycle. Without a match nothing changes.
inline constexpr Transition TRANSITIONS[] = {
    {UNDER_WAY, event::LIMIT, 0, 0, Action::STOP, State::IDLE, Failure::LIMIT_HIT},
    {UNDER_WAY, event::ABORT, 0, 0, Action::STOP, State::IDLE, Failure::ABORTED},
    {UNDER_WAY, event::OFF, 0, 0, Action::STOP, State::IDLE, Failure::ABORTED},
    {UNDER_WAY, event::MEMBER_FAILED, 0, 0, Action::STOP, State::IDLE},
    {UNDER_WAY, event::TEAM_SKEWED, 0, 0, Action::STOP, State::IDLE, Failure::TEAM_SKEWED},

    {State::IDLE, event::BEGIN, setting::LOCKING, 0, Action::UNLOCK, State::UNLOCK},
    {State::IDLE, event::BEGIN, 0, 0, Action::NOTHING, State::START},

    {State::UNLOCK, event::TEAM_UNLOCKED, 0, 0, Action::NOTHING, State::START},
    {State::UNLOCK, event::OVERDUE, 0, 0, Action::STOP, State::IDLE, Failure::NOT_UNLOCKED},

    {State::START, event::TEAM_DIFFERS, 0, 0, Action::STOP, State::IDLE, Failure::TEAM_DIFFERS},
    {State::START, 0, setting::STAYING | setting::LOCKING, 0, Action::SET_PLACE, State::LOCK},
    {State::START, 0, setting::STAYING, 0, Action::SET_PLACE, State::IDLE, Failure::NONE, true},
    {State::START, 0, setting::ABSOLUTE, 0, Action::SET_PLACE, State::WAIT_FOR_GROUP},
    {State::START, 0, 0, setting::SEARCHING | setting::LATCHING | setting::INDEX, Action::SET_PLACE,
     State::WAIT_FOR_GROUP},
    {State::START, 0, setting::SEARCHING, setting::LATCHING, Action::STOP, State::IDLE,
     Failure::SEARCH_WITHOUT_LATCH},
    {State::START, 0, 0, setting::LATCHING, Action::STOP, State::IDLE, Failure::INDEX_WITHOUT_LATCH},
    {State::START, 0, 0, setting::SEARCHING | setting::INDEX, Action::STOP, State::IDLE,
     Failure::LATCH_WITHOUT_INDEX},
    {State::START, 0, 0, setting::SEARCHING, Action::LATCH_ASK_INDEX, State::INDEX},
    {State::START, event::SWITCH_CLOSED, setting::SHARED, 0, Action::STOP, State::IDLE,
     Failure::SHARED_SWITCH_CLOSED},
    {State::START, event::TEAM_CLOSED, 0, 0, Action::BACK_OFF, State::INITIAL_BACKOFF},
    {State::START, 0, 0, 0, Action::SEARCH, State::SEARCH},

    {State::INITIAL_BACKOFF, event::TEAM_OPEN, 0, 0, Action::STOP, State::INITIAL_BACKOFF_STOP},
    {State::INITIAL_BACKOFF, event::AT_REST | event::SWITCH_CLOSED, 0, 0, Action::STOP, State::IDLE,
     Failure::SWITCH_STUCK},
    {State::INITIAL_BACKOFF_STOP, event::TEAM_SETTLED, 0, 0, Action::SEARCH, State::SEARCH},

    {State::SEARCH, event::SWITCH_CLOSED, 0, 0, Action::STOP, State::SEARCH_STOP},
    {State::SEARCH, event::AT_REST, 0, 0, Action::STOP, State::IDLE, Failure::SWITCH_NOT_FOUND},
    {State::SEARCH_STOP, event::TEAM_SETTLED | event::SWITCH_OPEN, 0, 0, Action::STOP, State::IDLE,
     Failure::SWITCH_LOST},
    {State::SEARCH_STOP, event::TEAM_SETTLED, setting::SAME_WAY, 0, Action::BACK_OFF, State::LATCH_BACKOFF},
    {State::SEARCH_STOP, event::TEAM_SETTLED, 0, 0, Action::LATCH, State::LATCH},

    {State::LATCH_BACKOFF, event::TEAM_OPEN, 0, 0, Action::STOP, State::LATCH_BACKOFF_STOP},
    {State::LATCH_BACKOFF, event::AT_REST | event::SWITCH_CLOSED, 0, 0, Action::STOP, State::IDLE,
     Failure::SWITCH_STUCK},
    {State::LATCH_BACKOFF_STOP, event::TEAM_SETTLED | event::SWITCH_CLOSED, 0, 0, Action::STOP, State::IDLE,
     Failure::SWITCH_CLOSED_AGAIN},
    {State::LATCH_BACKOFF_STOP, event::TEAM_SETTLED, 0, 0, Action::LATCH, State::LATCH},

    {State::LATCH, event::SWITCH_CLOSED, setting::SAME_WAY | setting::INDEX, 0, Action::ASK_INDEX,
     State::INDEX},
    {State::LATCH, event::SWITCH_CLOSED, setting::SAME_WAY | setting::TEAM, 0, Action::SET_PLACE,
     State::LATCHED},
    {State::LATCH, event::SWITCH_CLOSED, setting::SAME_WAY, 0, Action::SET_PLACE_STOP, State::LATCHED_STOP},
    {State::LATCH, event::SWITCH_OPEN, setting::INDEX, setting::SAME_WAY, Action::ASK_INDEX, State::INDEX},
    {State::LATCH, event::SWITCH_OPEN, setting::TEAM, setting::SAME_WAY, Action::SET_PLACE, State::LATCHED},
    {State::LATCH, event::SWITCH_OPEN, 0, setting::SAME_WAY, Action::SET_PLACE_STOP, State::LATCHED_STOP},
    {State::LATCH, event::AT_REST, setting::SAME_WAY, 0, Action::STOP, State::IDLE,
     Failure::SWITCH_NOT_FOUND},
    {State::LATCH, event::AT_REST, 0, 0, Action::STOP, State::IDLE, Failure::SWITCH_STUCK},

    {State::INDEX, event::INDEX, setting::TEAM, 0, Action::TAKE_INDEX, State::LATCHED},
    {State::INDEX, event::INDEX, 0, 0, Action::TAKE_INDEX_STOP, State::LATCHED_STOP},
    {State::INDEX, event::AT_REST, 0, 0, Action::STOP, State::IDLE, Failure::INDEX_NOT_FOUND},
    {State::LATCHED, event::TEAM_LATCHED, 0, 0, Action::STOP, State::LATCHED_STOP},
    {State::LATCHED_STOP, event::AT_REST, 0, 0, Action::NOTHING, State::WAIT_FOR_GROUP},

    {State::WAIT_FOR_GROUP, event::GROUP_READY, 0, 0, Action::GO_HOME, State::FINAL},
    {State::FINAL, event::TEAM_AT_REST, setting::LOCKING, 0, Action::NOTHING, State::LOCK},
    {State::FINAL, event::TEAM_AT_REST, 0, 0, Action::NOTHING, State::IDLE, Failure::NONE, true},
    {State::LOCK, event::LOCKED, 0, 0, Action::NOTHING, State::IDLE, Failure::NONE, true},
    {State::LOCK, event::OVERDUE, 0, 0, Action::STOP, State::IDLE, Failure::NOT_LOCKED},
};

/// Message of a failure for the operator, without the joint. [not realtime]
const char *failure_text(Failure failure) noexcept;

}  // namespace mw::homing

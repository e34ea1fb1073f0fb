// SPDX-License-Identifier: GPL-2.0-or-later
#include "machine/task/run/run_state.hh"

#include <array>

namespace mw::task {
namespace {

template <class State>
using Row = std::array<Transition<State>, static_cast<std::size_t>(State::COUNT)>;
template <class State>
using Table = std::array<Row<State>, static_cast<std::size_t>(RunEvent::COUNT)>;

constexpr Transition<RunPhase> phase(RunPhase to) {
    return {to, nullptr};
}
constexpr Transition<RunPhase> no_phase(const char *why) {
    return {RunPhase::IDLE, why};
}
constexpr Transition<Hold> hold(Hold to) {
    return {to, nullptr};
}
constexpr Transition<Hold> no_hold(const char *why) {
    return {Hold::GOING, why};
}

constexpr auto IDLE = phase(RunPhase::IDLE), CLEANING = phase(RunPhase::CLEANING),
               STARTING = phase(RunPhase::STARTING), SEARCHING = phase(RunPhase::SEARCHING),
               READING = phase(RunPhase::READING), SYNCHING = phase(RunPhase::SYNCHING),
               FINISHING = phase(RunPhase::FINISHING);
constexpr auto BUSY = no_phase("a program or MDI line is already running");
/// Reason for events that are not commands; it is not reported.
constexpr const char *LATE = "late";
constexpr auto NOT_DUE = no_phase(LATE), NOT_READING = no_phase(LATE), NO_SYNC = no_phase(LATE),
               NO_STOP = no_phase(LATE);
constexpr auto NO_PAUSE = no_phase("no running program to pause");
constexpr auto NO_RESUME = no_phase("nothing is paused");
constexpr auto NO_STEP = no_phase("no running program to step");
constexpr auto NO_RELEASE = no_phase("no paused program with axes to release");
constexpr auto NO_PLACE = no_phase("no approach is proposed");

/// Columns: IDLE, CLEANING, STARTING, SEARCHING, READING, SYNCHING, FINISHING.
constexpr Table<RunPhase> PHASES{{
    /* START */ {STARTING, STARTING, BUSY, BUSY, BUSY, BUSY, BUSY},
    /* BEGUN */ {NOT_DUE, NOT_DUE, READING, READING, NOT_DUE, NOT_DUE, NOT_DUE},
    /* SEARCH */ {NOT_DUE, NOT_DUE, SEARCHING, NOT_DUE, NOT_DUE, NOT_DUE, NOT_DUE},
    /* SYNC */ {NOT_READING, NOT_READING, NOT_READING, NOT_READING, SYNCHING, NOT_READING, NOT_READING},
    /* SYNCED */ {NO_SYNC, NO_SYNC, NO_SYNC, NO_SYNC, NO_SYNC, READING, NO_SYNC},
    /* READ */ {NOT_READING, NOT_READING, NOT_READING, NOT_READING, FINISHING, FINISHING, FINISHING},
    /* END */ {IDLE, CLEANING, IDLE, IDLE, IDLE, IDLE, IDLE},
    /* CLEAN */ {CLEANING, CLEANING, BUSY, BUSY, BUSY, BUSY, BUSY},
    /* CLEANED */ {IDLE, IDLE, STARTING, SEARCHING, READING, SYNCHING, FINISHING},
    /* PAUSE */ {NO_PAUSE, NO_PAUSE, STARTING, SEARCHING, READING, SYNCHING, FINISHING},
    /* RESUME */ {NO_RESUME, NO_RESUME, STARTING, SEARCHING, READING, SYNCHING, FINISHING},
    /* STEP */ {NO_STEP, NO_STEP, STARTING, SEARCHING, READING, SYNCHING, FINISHING},
    /* STEP_MOVE */ {NO_STEP, NO_STEP, STARTING, SEARCHING, READING, SYNCHING, FINISHING},
    /* STEP_DONE */ {NO_STEP, NO_STEP, STARTING, SEARCHING, READING, SYNCHING, FINISHING},
    /* PROGRAM_STOP */ {NO_STOP, NO_STOP, STARTING, SEARCHING, READING, SYNCHING, FINISHING},
    /* RELEASE */ {NO_RELEASE, NO_RELEASE, NO_RELEASE, NO_RELEASE, READING, SYNCHING, FINISHING},
    /* PROPOSE */ {NO_PLACE, NO_PLACE, NO_PLACE, SEARCHING, READING, SYNCHING, FINISHING},
    /* CONFIRM */ {NO_PLACE, NO_PLACE, NO_PLACE, READING, READING, SYNCHING, FINISHING},
}};

constexpr auto GOING = hold(Hold::GOING), STEPPING = hold(Hold::STEPPING), HELD = hold(Hold::HELD),
               STOPPED = hold(Hold::STOPPED), PROPOSED = hold(Hold::PROPOSED), AWAY = hold(Hold::AWAY);
constexpr auto NOT_HELD = no_hold("nothing is paused");
constexpr auto NOT_STEPPING = no_hold(LATE);
constexpr auto NO_WAY = no_hold("no approach is proposed");
constexpr auto NOT_RELEASABLE = no_hold("the axes can only be released while a program is paused");
constexpr auto RETURN_FIRST = no_hold("the axes of the program are released: resume the program first");
constexpr auto CONFIRM_FIRST = no_hold("the proposed approach waits for confirmation");

/// Columns: GOING, STEPPING, HELD, STOPPED, PROPOSED, AWAY.
constexpr Table<Hold> HOLDS{{
    /* START */ {GOING, GOING, GOING, GOING, GOING, GOING},
    /* BEGUN */ {GOING, STEPPING, HELD, STOPPED, PROPOSED, AWAY},
    /* SEARCH */ {GOING, STEPPING, HELD, STOPPED, PROPOSED, AWAY},
    /* SYNC */ {GOING, STEPPING, HELD, STOPPED, PROPOSED, AWAY},
    /* SYNCED */ {GOING, STEPPING, HELD, STOPPED, PROPOSED, AWAY},
    /* READ */ {GOING, STEPPING, HELD, STOPPED, PROPOSED, AWAY},
    /* END */ {GOING, GOING, GOING, GOING, GOING, GOING},
    /* CLEAN */ {GOING, GOING, GOING, GOING, GOING, GOING},
    /* CLEANED */ {GOING, STEPPING, HELD, STOPPED, PROPOSED, AWAY},
    /* PAUSE */ {HELD, HELD, HELD, STOPPED, PROPOSED, AWAY},
    /* RESUME */ {NOT_HELD, NOT_HELD, GOING, GOING, GOING, RETURN_FIRST},
    /* STEP */ {HELD, STEPPING, STEPPING, STEPPING, CONFIRM_FIRST, RETURN_FIRST},
    /* STEP_MOVE */ {HELD, STEPPING, HELD, HELD, CONFIRM_FIRST, RETURN_FIRST},
    /* STEP_DONE */ {NOT_STEPPING, HELD, NOT_STEPPING, NOT_STEPPING, NOT_STEPPING, NOT_STEPPING},
    /* PROGRAM_STOP */ {STOPPED, STOPPED, STOPPED, STOPPED, PROPOSED, AWAY},
    /* RELEASE */ {NOT_RELEASABLE, NOT_RELEASABLE, AWAY, AWAY, AWAY, AWAY},
    /* PROPOSE */ {PROPOSED, PROPOSED, PROPOSED, PROPOSED, PROPOSED, PROPOSED},
    /* CONFIRM */ {NO_WAY, NO_WAY, NO_WAY, NO_WAY, GOING, NO_WAY},
}};

template <class State>
const Transition<State> &entry(const Table<State> &table, RunEvent event, State from) {
    return table[static_cast<std::size_t>(event)][static_cast<std::size_t>(from)];
}

}  // namespace

Transition<RunPhase> transition(RunEvent event, RunPhase from) {
    return entry(PHASES, event, from);
}

Transition<Hold> transition(RunEvent event, Hold from) {
    return entry(HOLDS, event, from);
}

const char *name_of(RunPhase phase) {
    constexpr std::array NAMES{"IDLE",    "CLEANING", "STARTING", "SEARCHING",
                               "READING", "SYNCHING", "FINISHING"};
    static_assert(NAMES.size() == static_cast<std::size_t>(RunPhase::COUNT));
    return NAMES[static_cast<std::size_t>(phase)];
}

const char *name_of(Hold hold) {
    constexpr std::array NAMES{"GOING", "STEPPING", "HELD", "STOPPED", "PROPOSED", "AWAY"};
    static_assert(NAMES.size() == static_cast<std::size_t>(Hold::COUNT));
    return NAMES[static_cast<std::size_t>(hold)];
}

const char *name_of(RunEvent event) {
    constexpr std::array NAMES{"START",     "BEGUN",     "SEARCH",       "SYNC",    "SYNCED",  "READ",
                               "END",       "CLEAN",     "CLEANED",      "PAUSE",   "RESUME",  "STEP",
                               "STEP_MOVE", "STEP_DONE", "PROGRAM_STOP", "RELEASE", "PROPOSE", "CONFIRM"};
    static_assert(NAMES.size() == static_cast<std::size_t>(RunEvent::COUNT));
    return NAMES[static_cast<std::size_t>(event)];
}

Result<> RunState::take(RunEvent event) {
    const auto phase = transition(event, phase_);
    const auto hold = transition(event, hold_);
    if (phase.refusal != nullptr || hold.refusal != nullptr) {
        return fail(phase.refusal != nullptr ? phase.refusal : hold.refusal);
    }
    phase_ = phase.to;
    hold_ = hold.to;
    return {};
}

}  // namespace mw::task

// SPDX-License-Identifier: GPL-2.0-or-later
// How a program or line runs: its phase, and whether it is held. Two tables say what each event leads to.
#pragma once

#include <cstdint>

#include "base/result.hh"

namespace mw::task {

enum class RunPhase : std::uint8_t {
    IDLE,
    CLEANING,   ///< nothing runs; what an abort has asked for is on its way
    STARTING,   ///< asked for; begins when the axes are at rest
    SEARCHING,  ///< what comes before the place where it is to begin is calculated
    READING,    ///< the interpreter reads ahead
    SYNCHING,   ///< the interpreter waits until everything before is done
    FINISHING,  ///< all is read; the rest is carried out
    COUNT
};

enum class Hold : std::uint8_t {
    GOING,
    STEPPING,  ///< until the end of a block
    HELD,      ///< by the operator, or after a step
    STOPPED,   ///< by M0, M1 or M60
    PROPOSED,  ///< until a person confirms the way to where it goes on
    AWAY,      ///< the axes are released: they are jogged, the program keeps its place
    COUNT
};

enum class RunEvent : std::uint8_t {
    START,         ///< the operator runs a program or line
    BEGUN,         ///< the axes are at rest, the interpreter begins
    SEARCH,        ///< the same, not from the first line
    SYNC,          ///< the interpreter must wait
    SYNCED,        ///< it may go on
    READ,          ///< it has come to the end
    END,           ///< carried out, failed or aborted
    CLEAN,         ///< after an abort: nothing may run on, the rest is put in order
    CLEANED,       ///< that is done
    PAUSE,         ///< the operator holds
    RESUME,        ///< the operator goes on
    STEP,          ///< the operator goes on for one block
    STEP_MOVE,     ///< the operator lets a held planner make one move
    STEP_DONE,     ///< the block is carried out
    PROGRAM_STOP,  ///< M0, M1 or M60 are reached
    RELEASE,       ///< the operator wants the axes of a held program
    PROPOSE,       ///< the way to where it goes on is known
    CONFIRM,       ///< a person has agreed to it
    COUNT
};

/// Phase and hold of the run. Pure; one thread.
class RunState {
  public:
    /// An event that cannot be in this state changes nothing and says why.
    Result<> take(RunEvent event);

    RunPhase phase() const { return phase_; }
    Hold hold() const { return hold_; }
    bool isRunning() const { return phase_ >= RunPhase::STARTING; }
    bool isHeld() const { return hold_ >= Hold::HELD; }

  private:
    RunPhase phase_ = RunPhase::IDLE;
    Hold hold_ = Hold::GOING;
};

/// What an event leads to: a state, or a reason why not.
template <class State>
struct Transition {
    State to;
    const char *refusal;  ///< null: allowed
};
Transition<RunPhase> transition(RunEvent event, RunPhase from);
Transition<Hold> transition(RunEvent event, Hold from);

const char *name_of(RunPhase phase);
const char *name_of(Hold hold);
const char *name_of(RunEvent event);

}  // namespace mw::task

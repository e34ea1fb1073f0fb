// SPDX-License-Identifier: GPL-2.0-or-later
// The state of a run: its phase, and whether it is paused. Two tables give the result of each event.
#pragma once

#include <cstdint>

#include "base/result.hh"

namespace mw::task {

enum class RunPhase : std::uint8_t {
    IDLE,
    CLEANING,   ///< nothing runs; actions after an abort are being executed
    STARTING,   ///< requested; begins when the axes are stopped
    SEARCHING,  ///< the state at the start position is calculated
    READING,    ///< the interpreter reads ahead
    SYNCHING,   ///< the interpreter waits until all earlier items are done
    FINISHING,  ///< everything is read; the rest is being executed
    COUNT
};

enum class Hold : std::uint8_t {
    GOING,
    STEPPING,  ///< runs until the end of a block
    HELD,      ///< paused by the operator, or after a step
    STOPPED,   ///< paused by M0, M1 or M60
    PROPOSED,  ///< paused until a person confirms the approach
    AWAY,      ///< the axes are released for jogging; the program keeps its position
    COUNT
};

enum class RunEvent : std::uint8_t {
    START,         ///< the operator runs a program or line
    BEGUN,         ///< the axes are stopped, the interpreter starts
    SEARCH,        ///< as BEGUN, but not from the first line
    SYNC,          ///< the interpreter must wait
    SYNCED,        ///< the interpreter may continue
    READ,          ///< the interpreter has reached the end
    END,           ///< completed, failed or aborted
    CLEAN,         ///< after an abort: cleans up
    CLEANED,       ///< clean-up is done
    PAUSE,         ///< the operator pauses
    RESUME,        ///< the operator resumes
    STEP,          ///< the operator resumes for one block
    STEP_MOVE,     ///< the operator requests one move of a paused planner
    STEP_DONE,     ///< the block is done
    PROGRAM_STOP,  ///< M0, M1 or M60 is reached
    RELEASE,       ///< the operator releases the axes of a paused program
    PROPOSE,       ///< the approach is known
    CONFIRM,       ///< a person has confirmed the approach
    COUNT
};

/// Phase and hold of the run. It has no side effects. All calls come from one thread.
class RunState {
  public:
    /// An event that is not possible in this state changes nothing and returns the reason.
    Result<> take(RunEvent event);

    RunPhase phase() const { return phase_; }
    Hold hold() const { return hold_; }
    bool isRunning() const { return phase_ >= RunPhase::STARTING; }
    bool isHeld() const { return hold_ >= Hold::HELD; }

  private:
    RunPhase phase_ = RunPhase::IDLE;
    Hold hold_ = Hold::GOING;
};

/// Result of an event: a state, or the reason for a rejection.
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

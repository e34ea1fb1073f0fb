// SPDX-License-Identifier: GPL-2.0-or-later
// Finding the machine's zero: one state machine per joint, in sequences and synchronised groups. Pure,
// realtime-safe. Source of the behaviour: LinuxCNC's integrator manual, "Homing Configuration".
#pragma once

#include <array>
#include <cstdint>

#include "base/limits.hh"

namespace mw::homing {

enum class State : std::uint8_t {
    IDLE,
    START,
    INITIAL_BACKOFF,  ///< off a switch that was closed at the start
    INITIAL_BACKOFF_STOP,
    SEARCH,  ///< towards the switch
    SEARCH_STOP,
    LATCH_BACKOFF,  ///< off the switch, to come again slowly
    LATCH_BACKOFF_STOP,
    LATCH,  ///< slowly to the edge of the switch
    INDEX,  ///< slowly to the index pulse
    LATCHED_STOP,
    WAIT_FOR_GROUP,  ///< synchronised joints wait for one another before the final move
    FINAL,
};

enum class Failure : std::uint8_t {
    NONE,
    SEARCH_WITHOUT_LATCH,  ///< HOME_SEARCH_VEL is set, HOME_LATCH_VEL is 0
    LATCH_WITHOUT_INDEX,   ///< HOME_LATCH_VEL is set without a search velocity and without index
    INDEX_WITHOUT_LATCH,   ///< HOME_USE_INDEX is set, HOME_LATCH_VEL is 0
    SHARED_SWITCH_CLOSED,
    SWITCH_NOT_FOUND,
    SWITCH_STUCK,  ///< backing off did not open it
    SWITCH_LOST,   ///< found, but open again after stopping
    INDEX_NOT_FOUND,
    LIMIT_HIT,
    ABORTED,
    GROUP_FAILED,  ///< another joint of the group or sequence failed
};

/// Positions in joint units, speeds in joint units per second.
struct Parameters {
    double search_vel = 0, latch_vel = 0, final_vel = -1;
    double home = 0, offset = 0;
    bool isUsingIndex = false, isIndexWithoutReset = false;
    bool isSharedSwitch = false, isIgnoringLimits = false;
    int absolute_encoder = 0;
    int sequence = NO_SEQUENCE;
    double travel = 0;  ///< how far to search at most

    static constexpr int NO_SEQUENCE = 1000;
    bool isInSequence() const noexcept { return sequence > -100 && sequence < 100; }
};

struct JointInput {
    bool isSwitchClosed = false;
    bool isIndexEnabled = false;  ///< the index-enable pin, which the encoder clears at the index
    bool isAtRest = true;         ///< of the joint's planner
    bool isOnLimit = false;       ///< a limit switch that counts is closed
    double pos_fb = 0;
};

enum class Move : std::uint8_t { NONE, STOP, BY, TO };

/// What one joint shall do in this cycle.
struct JointCommand {
    Move move = Move::NONE;
    double value = 0;         ///< BY: signed distance; TO: position, after the shift
    double velocity = 0;      ///< > 0; 0: the joint's highest
    bool isShifting = false;  ///< positions and target all move by `shift`; the motor stays
    double shift = 0;
    bool isSettingZero =
        false;  ///< the encoder has just been reset: motor position 0 is joint position `zero`
    double zero = 0;
};

/// All methods: servo thread only.
class Homing {
  public:
    void set_num_joints(int count) noexcept { num_joints_ = count; }
    Parameters &parameters(int joint) noexcept { return joints_[index(joint)].parameters; }

    /// Starts one joint (its group, if its sequence is negative) or, with -1, all by sequence.
    void start(int joint) noexcept;
    /// Stops the whole of what is being homed; positions found so far are not used.
    void abort(Failure why) noexcept;
    void unhome(int joint) noexcept { joints_[index(joint)].isHomed = false; }

    /// Advances every joint by one cycle; `commands` of joints that are not homing are NONE.
    void step(const JointInput *inputs, JointCommand *commands) noexcept;

    bool isHoming(int joint) const noexcept { return joints_[index(joint)].state != State::IDLE; }
    bool isHomed(int joint) const noexcept { return joints_[index(joint)].isHomed; }
    bool isActive() const noexcept;
    /// `step` has something to do: it is active, or a joint is still to be told to stop.
    bool hasWork() const noexcept;
    bool isAllHomed() const noexcept;
    State state(int joint) const noexcept { return joints_[index(joint)].state; }
    bool isIndexWanted(int joint) const noexcept { return joints_[index(joint)].isIndexWanted; }
    bool isIgnoringLimits(int joint) const noexcept {
        return isHoming(joint) && joints_[index(joint)].parameters.isIgnoringLimits;
    }
    /// The failure of the last cycle's step: joint or -1; reading it clears it.
    int take_failure(Failure &why) noexcept;

  private:
    struct Joint {
        Parameters parameters;
        State state = State::IDLE;
        bool isHomed = false;
        bool isIndexWanted = false;
        bool isMoving = false;  ///< a move of this state has been commanded
        int wait = 0;
    };
    static std::size_t index(int joint) noexcept { return static_cast<std::size_t>(joint); }

    void begin(int joint) noexcept;
    bool start_sequence(int number) noexcept;
    void advance_sequence() noexcept;
    bool isGroupReady(int joint) const noexcept;
    void fail(int joint, Failure why) noexcept;
    Failure step_joint(Joint &j, const JointInput &in, JointCommand &out) noexcept;
    Failure step_start(Joint &j, const JointInput &in, JointCommand &out) noexcept;
    Failure step_latch(Joint &j, const JointInput &in, JointCommand &out) noexcept;
    Failure step_index(Joint &j, const JointInput &in, JointCommand &out) noexcept;
    void finish_latch(Joint &j, JointCommand &out) noexcept;

    std::array<Joint, MAX_JOINTS> joints_{};
    int num_joints_ = 0;
    int sequence_ = -1;  ///< being homed by "all", -1: none
    int failed_joint_ = -1;
    Failure failure_ = Failure::NONE;
    JointCommand stops_[MAX_JOINTS];
    bool isStopping_[MAX_JOINTS] = {};
};

/// What to tell the operator about a failure; the text names no joint. [not realtime]
const char *failure_text(Failure failure) noexcept;

}  // namespace mw::homing

// SPDX-License-Identifier: GPL-2.0-or-later
// The interface between motion and homing: `Homing`, or a user's module instead.
#pragma once

#include <cstdint>

#include "motion/homing/table.hh"

namespace mw::homing {

/// Positions in joint units, speeds in joint units per second.
struct Parameters {
    double search_vel = 0, latch_vel = 0, final_vel = -1;
    double home = 0, offset = 0;
    bool isUsingIndex = false, isIndexWithoutReset = false;
    bool isSharedSwitch = false, isIgnoringLimits = false;
    bool isLockingIndexer = false, isVolatile = false;
    int absolute_encoder = 0;
    int sequence = NO_SEQUENCE;
    double travel = 0;         ///< maximum search distance
    double max_skew = 0;       ///< maximum difference between joints of a team; 0: a hundredth of the range
    double low = 0, high = 0;  ///< soft limits, which apply once the joint is homed
    double clearance =
        0;  ///< distance to back off from the opening edge, to approach it again in the same direction
    int axis = -1;  ///< axis that it moves, alone or with others; -1: none
    bool isActive = true;

    static constexpr int NO_SEQUENCE = 1000;
    bool isInSequence() const noexcept { return sequence > -100 && sequence < 100; }
};

struct JointInput {
    bool isSwitchClosed = false;
    bool isIndexEnabled = false;  ///< the index-enable pin, which the encoder clears at the index
    bool isUnlocked = false;      ///< of a locking indexer
    bool isAtRest = true;         ///< of the joint's planner
    double pos_cmd = 0, pos_fb = 0;
    double vel_cmd = 0;       ///< of the last cycle
    double motor_pos_fb = 0;  ///< motor position = joint position + motor_offset + backlash
    double motor_offset = 0;
    double max_velocity = 0, max_acceleration = 0;
    double max_jerk = 0;  ///< 0: none
    bool isOnPosLimit = false, isOnNegLimit = false;
};

enum class Move : std::uint8_t { NONE, STOP, BY, TO };

/// Command to one joint in this cycle. Motion keeps it within the limits of the joint.
struct JointCommand {
    Move move = Move::NONE;
    double value = 0;          ///< BY: signed distance; TO: position after the shift
    double velocity = 0;       ///< > 0; 0: maximum of the joint
    double most_velocity = 0;  ///< limit of the override; 0: maximum of the joint
    double acceleration = 0;   ///< 0: maximum of the joint
    double jerk = 0;           ///< of moves that end only at their target; 0: maximum of the joint
    bool isSmooth = false;     ///< such a move
    bool isShifting = false;   ///< position and target change by `shift`; the motor does not move
    double shift = 0;
    bool isSettingZero =
        false;  ///< the encoder has just been reset: motor position 0 is joint position `zero`
    double zero = 0;
};

/// All functions: servo thread only; none allocates, locks or blocks. Arrays have MAX_JOINTS elements.
class Module {
  public:
    virtual void set_num_joints(int count) noexcept = 0;
    virtual void configure(int joint, const Parameters &parameters) noexcept = 0;
    /// Starts one joint or, with -1, all by sequence.
    virtual void start(int joint) noexcept = 0;
    /// Stops all homing. `why` is LIMIT, ABORT or OFF; `joint` is its joint, -1: none.
    virtual void abort(event::Event why, int joint) noexcept = 0;
    virtual void unhome(int joint) noexcept = 0;

    /// Called first and last in every cycle, also while the machine is off.
    virtual void read_pins() noexcept {}
    virtual void write_pins() noexcept {}

    /// Advances by one cycle; `commands` of joints that are not homing are NONE.
    virtual void step(const JointInput *inputs, JointCommand *commands) noexcept = 0;

    virtual bool isHoming(int joint) const noexcept = 0;
    virtual bool isHomed(int joint) const noexcept = 0;
    virtual bool isActive() const noexcept = 0;
    /// True if `step` has work: homing is active, or a joint still has to be stopped.
    virtual bool hasWork() const noexcept = 0;
    /// The homing step for diagnostics; 0: none.
    virtual int step_number(int joint) const noexcept = 0;
    /// True while the index-enable pin is set. Also reports whether the joint moves towards the index pulse.
    virtual bool isIndexWanted(int joint) const noexcept = 0;
    virtual bool isAtIndex(int joint) const noexcept = 0;
    virtual bool isUnlockWanted(int joint) const noexcept = 0;
    /// The failure since the last call: its joint, or -1.
    virtual int take_failure(Failure &why) noexcept = 0;
    /// Bit per joint whose command was clamped to its limits since the last call.
    virtual std::uint32_t take_clamped() noexcept { return 0; }
    /// From this call on, outputs that require machine on are off.
    virtual void lock() noexcept = 0;

  protected:
    ~Module() = default;
};

}  // namespace mw::homing

// SPDX-License-Identifier: GPL-2.0-or-later
// Homing: the table of `table.hh` for each joint, in sequences, groups that end together, and teams that move
// one axis. Pure and realtime-safe. It behaves as LinuxCNC's integrator manual describes in "Homing
// Configuration".
#pragma once

#include <array>
#include <cstdint>

#include "base/limits.hh"
#include "motion/homing/module.hh"
#include "motion/homing/table.hh"

namespace mw::homing {

/// All methods: servo thread only.
class Homing final : public Module {
  public:
    void set_period(double period_s) noexcept { period_s_ = period_s; }
    void set_num_joints(int count) noexcept override {
        num_joints_ = count;
        summary_.isCurrent = false;
    }
    void configure(int joint, const Parameters &p) noexcept override { at(joint).parameters = p; }
    Parameters &parameters(int joint) noexcept { return at(joint).parameters; }
    const Parameters &parameters(int joint) const noexcept { return at(joint).parameters; }

    /// Homes one joint; also its group if its sequence is negative.
    void start(int joint) noexcept override;
    /// Positions found so far are not used.
    void abort(event::Event why = event::ABORT, int joint = -1) noexcept override;
    void unhome(int joint) noexcept override { at(joint).isHomed = false; }
    void step(const JointInput *inputs, JointCommand *commands) noexcept override;
    void lock() noexcept override;

    bool isHoming(int joint) const noexcept override { return at(joint).state != State::IDLE; }
    bool isHomed(int joint) const noexcept override { return at(joint).isHomed; }
    bool isActive() const noexcept override { return sequence_ >= 0 || summary().isAnyHoming; }
    bool hasWork() const noexcept override { return sequence_ >= 0 || summary().isAnyBusy; }
    struct Summary {
        bool isCurrent = false;
        bool isAnyHoming = false, isAnyBusy = false;
        bool isQuiet = true;      ///< no joint is commanded and no step is reported
        std::uint32_t homed = 0;  ///< bit per joint
    };
    /// Summary of all joints, recalculated when a joint may have changed.
    const Summary &summary() const noexcept {
        if (!summary_.isCurrent) [[unlikely]] {
            summarise();
        }
        return summary_;
    }
    State state(int joint) const noexcept { return at(joint).state; }
    int step_number(int joint) const noexcept override { return static_cast<int>(state(joint)); }
    bool isIndexWanted(int joint) const noexcept override { return at(joint).isIndexWanted; }
    bool isAtIndex(int joint) const noexcept override {
        return state(joint) == State::INDEX || at(joint).isIndexReleased;
    }
    bool isUnlockWanted(int joint) const noexcept override { return at(joint).isUnlockWanted; }
    int take_failure(Failure &why) noexcept override;

    /// Maximum time of an indexer to unlock or lock [s].
    static constexpr double LONGEST_LOCKING_S = 30;
    /// Maximum duration of contact bounce [s]; the contact is read again after this time.
    static constexpr double LONGEST_BOUNCE_S = 0.02;

  private:
    struct Joint {
        Parameters parameters;
        State state = State::IDLE;
        bool isHomed = false;
        bool isIndexWanted = false, isUnlockWanted = false, isStopping = false;
        bool isIndexReleased =
            false;              ///< set in this cycle by a failure: the encoder may just have reset itself
        int wait = 0;           ///< cycles in this state
        double way = 0;         ///< travel commanded since homing began; setting the zero does not change it
        double closed_way = 0;  ///< `way` at which its switch was last closed
        double team_acceleration = 0;  ///< 0: its own
    };
    /// Limits and command of a team.
    struct Leg {
        double velocity = 0, most_velocity = 0, acceleration = 0, travel = 0;
    };
    void summarise() const noexcept;

    Joint &at(int joint) noexcept {
        summary_.isCurrent = false;
        return joints_[static_cast<std::size_t>(joint)];
    }
    const Joint &at(int joint) const noexcept { return joints_[static_cast<std::size_t>(joint)]; }

    void begin(int joint) noexcept;
    bool start_sequence(int number) noexcept;
    void advance_sequence() noexcept;
    void fail(int joint, Failure why) noexcept;

    bool areTeam(int a, int b) const noexcept;
    bool hasTeam(int joint) const noexcept;
    std::uint32_t settings_of(int joint) const noexcept;
    std::uint32_t events_of(int joint, const JointInput *inputs) const noexcept;
    std::uint32_t team_events(int joint, const JointInput *inputs) const noexcept;
    bool isGroupReady(int joint) const noexcept;
    bool isSkewed(int a, int b, const JointInput *inputs) const noexcept;
    const Transition *transition(int joint, std::uint32_t events) const noexcept;
    void apply(int joint, const Transition &row, const JointInput *inputs, JointCommand &out) noexcept;
    void set_place(int joint, const JointInput &in, JointCommand &out) noexcept;
    void go(int joint, double Parameters::*velocity, double sign, const JointInput *inputs,
            JointCommand &out) noexcept;
    void go_home(int joint, const JointInput *inputs, JointCommand &out) noexcept;

    std::array<Joint, MAX_JOINTS> joints_{};
    mutable Summary summary_;
    int num_joints_ = 0;
    double period_s_ = 1e-3;
    int sequence_ = -1;  ///< sequence that "home all" executes, -1: none
    int failed_joint_ = -1;
    Failure failure_ = Failure::NONE;
};

}  // namespace mw::homing

// SPDX-License-Identifier: GPL-2.0-or-later
// Executes homing commands: starts when the jogs that it stopped have ended, and reports each failure once.
#pragma once

#include <array>
#include <cstdint>

#include "motion/homing/homing.hh"
#include "motion/homing/module.hh"
#include "motion/interface/command.hh"
#include "motion/interface/settings.hh"
#include "motion/servo/command_result.hh"
#include "motion/servo/io.hh"

namespace mw::motion {

struct HomeConditions {
    bool isReady = false;  ///< machine on and not stopping
    Mode mode = Mode::FREE;
    bool isInhibited = false, isMoving = false;
    std::uint32_t inactive = 0;       ///< bit per inactive joint
    std::uint32_t kept_while_on = 0;  ///< bit per joint that may not be unhomed now
};
struct HomingFailure {
    int joint = -1;  ///< -1: none
    homing::Failure why = homing::Failure::NONE;
};

class HomingDrive {
  public:
    /// `foreign`: replaces Millwright's homing, if it is not null.
    HomingDrive(double period_s, homing::Module *foreign) noexcept;

    /// Number of joints of the machine, and how many of them must be homed for the machine to be homed.
    void use_joints(int num_joints, int num_to_home) noexcept;
    /// Sets the axis that joint j moves, -1: none. Joints of one axis that end homing together remain
    /// aligned.
    void set_axis(int j, int axis) noexcept;
    /// Takes the settings of joint j.
    void configure(int j, const Settings &settings) noexcept;
    /// Sets the back-off distance for backlash; `configure` also does this.
    void set_clearance(int j, const Settings &settings) noexcept;

    /// Accepted means requested: all jogs must stop first.
    CommandResult take(const Home &command, const HomeConditions &conditions) noexcept;
    CommandResult take(const Unhome &command, const HomeConditions &conditions,
                       const Settings &settings) noexcept;
    void unhome(int j) noexcept { module().unhome(j); }
    /// `joint`: the joint that caused `why`, -1: none.
    void abort(homing::event::Event why, int joint = -1) noexcept;
    /// True if positions of a driver were lost since the last call: switch_off() must follow.
    bool note_lost_positions(std::uint32_t count) noexcept {
        if (count == lost_positions_) [[likely]] {
            return false;
        }
        lost_positions_ = count;
        positions_lost_ = true;
        return true;
    }
    /// Called when the machine is switched off. Joints with a volatile home lose it; all joints do if
    /// positions were lost.
    void switch_off(const Settings &settings) noexcept;

    /// Reads pins of a user's module at the start and end of a cycle.
    void read_pins() noexcept {
        if (foreign_ != nullptr) [[unlikely]] {
            foreign_->read_pins();
        }
    }
    void write_pins() noexcept {
        if (foreign_ != nullptr) [[unlikely]] {
            foreign_->write_pins();
        }
    }
    /// Starts homing that is due, one cycle before the joints move, when nothing moves. Returns the failure
    /// if it may not start.
    homing::Failure begin_due(const HomeConditions &conditions) noexcept;
    /// One cycle of all joints. If a command of a user's module is not a number, homing ends and false is
    /// returned.
    bool step(const homing::JointInput *inputs, homing::JointCommand *commands) noexcept;
    /// Failures of this cycle, without aborted joints.
    HomingFailure take_failure() noexcept;
    /// Bit per joint whose move was limited to its soft limits in this cycle.
    std::uint32_t take_clamped() noexcept;

    /// Bit per homed joint, whose soft limits now apply.
    [[gnu::hot]] std::uint32_t homed_joints() const noexcept;
    bool isAllHomed() const noexcept;
    // Called in every cycle, so Millwright's homing is called without the look-up of module().
    bool isActive() const noexcept { return isForeign() ? foreign_->isActive() : own_.isActive(); }
    bool hasWork() const noexcept { return isForeign() ? foreign_->hasWork() : own_.hasWork(); }
    bool isDue() const noexcept { return due_; }
    /// The joint that waits for its start, -1: all.
    int due_joint() const noexcept { return due_joint_; }
    /// True if active, or about to start.
    bool isUnderWay() const noexcept { return isActive() || due_; }
    bool isHoming(int j) const noexcept { return module().isHoming(j); }
    bool isAtIndex(int j) const noexcept { return module().isAtIndex(j); }
    bool isUnlockWanted(int j) const noexcept { return module().isUnlockWanted(j); }
    bool isIgnoringLimits(int j) const noexcept {
        return module().isHoming(j) && parameters(j).isIgnoringLimits;
    }
    const homing::Parameters &parameters(int j) const noexcept { return own_.parameters(j); }

    void fill(Outputs &out) const noexcept;

  private:
    bool isForeign() const noexcept {
        if (foreign_ != nullptr) [[unlikely]] {
            return true;
        }
        return false;
    }
    homing::Module &module() noexcept {
        return foreign_ != nullptr ? *foreign_ : static_cast<homing::Module &>(own_);
    }
    const homing::Module &module() const noexcept {
        return foreign_ != nullptr ? *foreign_ : static_cast<const homing::Module &>(own_);
    }
    int failed_foreign_joint() noexcept;

    homing::Homing own_;
    homing::Module *foreign_;
    int num_joints_ = 0;
    int num_to_home_ = 0;
    bool due_ = false;
    int due_joint_ = -1;
    std::uint32_t homing_joints_ =
        0;                        ///< bit per joint that was homing in the last cycle, for a user's module
    bool end_requested_ = false;  ///< a command ends homing
    std::uint32_t lost_positions_ = 0;  ///< Inputs::lost_positions as last seen
    bool positions_lost_ = false;       ///< all joints will lose their home when the machine is switched off
};

}  // namespace mw::motion

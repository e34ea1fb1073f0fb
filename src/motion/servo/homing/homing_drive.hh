// SPDX-License-Identifier: GPL-2.0-or-later
// Homing as a command: it begins when the jogs that it has stopped have ended, and reports each failure once.
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

struct HomingDrive {
    homing::Homing own;
    homing::Module *foreign = nullptr;  ///< replaces it
    int num_joints = 0;                 ///< of the machine
    int num_to_home = 0;                ///< joints of the kinematics: the machine is homed when these are
    bool isDue = false;
    int due = -1;                      ///< the joint, -1: all
    std::uint32_t known = 0;           ///< homed in the last cycle, bit per joint; of a user's module
    bool isEndAsked = false;           ///< it ends by a command
    std::uint32_t lost_positions = 0;  ///< Inputs::lost_positions as last seen
    bool arePositionsLost = false;     ///< all joints lose their homes when the machine is switched off next

    homing::Module &module() noexcept {
        return foreign != nullptr ? *foreign : static_cast<homing::Module &>(own);
    }
    const homing::Module &module() const noexcept {
        return foreign != nullptr ? *foreign : static_cast<const homing::Module &>(own);
    }
    // Called in every cycle; for Millwright's homing without the look-up of module().
    bool isActive() const noexcept {
        if (foreign != nullptr) [[unlikely]] {
            return foreign->isActive();
        }
        return own.isActive();
    }
    bool hasWork() const noexcept {
        if (foreign != nullptr) [[unlikely]] {
            return foreign->hasWork();
        }
        return own.hasWork();
    }
    std::uint32_t take_clamped() noexcept {
        if (foreign != nullptr) [[unlikely]] {
            return foreign->take_clamped();
        }
        return own.take_clamped();
    }
    /// Active, or about to begin.
    bool isUnderWay() const noexcept { return isActive() || isDue; }
    bool isIgnoringLimits(int joint) const noexcept {
        return module().isHoming(joint) && own.parameters(joint).isIgnoringLimits;
    }
};

/// Bit per homed joint: soft limits apply from there on.
[[gnu::hot]] std::uint32_t homed_mask(const HomingDrive &drive) noexcept;
bool isAllHomed(const HomingDrive &drive) noexcept;

struct HomeConditions {
    bool isReady = false;  ///< machine on and not stopping
    Mode mode = Mode::FREE;
    bool isInhibited = false, isMoving = false;
    std::uint32_t inactive = 0;       ///< bit per inactive joint
    std::uint32_t kept_while_on = 0;  ///< bit per joint that may not lose its home now
};
/// Accepted means requested: all jogs are stopped first.
CommandResult take(HomingDrive &drive, const Home &command, const HomeConditions &conditions) noexcept;
CommandResult take(HomingDrive &drive, const Unhome &command, const HomeConditions &conditions,
                   const Settings &settings) noexcept;

/// Takes the settings of joint j.
void configure(HomingDrive &drive, int j, const Settings &settings) noexcept;
/// Sets the distance to back off for backlash; `configure` does it too.
void note_play(HomingDrive &drive, int j, const Settings &settings) noexcept;
/// The axis that joint j moves, -1: none; joints of one axis that end homing together stay aligned.
void set_axis(HomingDrive &drive, int j, int axis) noexcept;
/// `joint`: the joint that caused `why`, -1: none.
void abort(HomingDrive &drive, homing::event::Event why, int joint = -1) noexcept;
/// True when positions of a driver were lost since the last call: switch_off() must follow.
inline bool note_lost_positions(HomingDrive &drive, std::uint32_t count) noexcept {
    if (count == drive.lost_positions) [[likely]] {
        return false;
    }
    drive.lost_positions = count;
    drive.arePositionsLost = true;
    return true;
}
/// Switched off: joints with a volatile home lose it; all do when positions were lost.
void switch_off(HomingDrive &drive, const Settings &settings) noexcept;

/// A cycle before the joints move: homing that is due begins when nothing moves. Returns the failure of
/// homing that may not begin.
homing::Failure begin_due(HomingDrive &drive, const HomeConditions &conditions) noexcept;
struct HomingFailure {
    int joint = -1;  ///< -1: none
    homing::Failure why = homing::Failure::NONE;
};
/// Failures of this cycle, without aborted joints.
HomingFailure take_failure(HomingDrive &drive) noexcept;
/// True if all commands of a user's module are finite numbers; otherwise homing ends.
bool areFinite(const HomingDrive &drive, const homing::JointCommand *commands) noexcept;

void fill(const HomingDrive &drive, Outputs &out) noexcept;

}  // namespace mw::motion

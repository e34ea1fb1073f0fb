// SPDX-License-Identifier: GPL-2.0-or-later
// Homing as a command: it begins when the jogs that it has stopped are at rest, and tells once what has
// failed.
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
    homing::Module *foreign = nullptr;  ///< takes its place
    int num_joints = 0;                 ///< of the machine
    int num_to_home = 0;                ///< of the kinematics: the machine is homed when these are
    bool isDue = false;
    int due = -1;             ///< the joint, -1: all
    std::uint32_t known = 0;  ///< homing in the last cycle, bit per joint; of a foreign module
    bool isEndAsked = false;  ///< it ends because it was told to

    homing::Module &module() noexcept {
        return foreign != nullptr ? *foreign : static_cast<homing::Module &>(own);
    }
    const homing::Module &module() const noexcept {
        return foreign != nullptr ? *foreign : static_cast<const homing::Module &>(own);
    }
    // What every cycle asks, of ours without the look-up that module() costs.
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
    /// Or about to begin.
    bool isUnderWay() const noexcept { return isActive() || isDue; }
    bool isIgnoringLimits(int joint) const noexcept {
        return module().isHoming(joint) && own.parameters(joint).isIgnoringLimits;
    }
};

/// Bit per homed joint: soft limits hold from there on.
[[gnu::hot]] std::uint32_t homed_mask(const HomingDrive &drive) noexcept;
bool isAllHomed(const HomingDrive &drive) noexcept;

struct HomeConditions {
    bool isReady = false;  ///< machine on, no stop under way
    Mode mode = Mode::FREE;
    bool isInhibited = false, isMoving = false;
    std::uint32_t inactive = 0;       ///< bit per joint that is left out
    std::uint32_t kept_while_on = 0;  ///< bit per joint that may not lose its home now
};
/// Done means asked for: whatever is jogged is to be brought to rest.
CommandResult take(HomingDrive &drive, const Home &command, const HomeConditions &conditions) noexcept;
CommandResult take(HomingDrive &drive, const Unhome &command, const HomeConditions &conditions,
                   const Settings &settings) noexcept;

/// Takes the settings of joint j.
void configure(HomingDrive &drive, int j, const Settings &settings) noexcept;
/// How far to back off for play; `configure` does it too.
void note_play(HomingDrive &drive, int j, const Settings &settings) noexcept;
/// The axis that joint j moves, -1: none; joints of one axis that end homing together keep together.
void set_axis(HomingDrive &drive, int j, int axis) noexcept;
/// `joint`: the one that `why` has happened to, -1: none.
void abort(HomingDrive &drive, homing::event::Event why, int joint = -1) noexcept;
/// Switched off: joints with a volatile home lose it.
void switch_off(HomingDrive &drive, const Settings &settings) noexcept;

/// A cycle before the joints move: homing that is due begins when nothing moves; the failure of one that may
/// not.
homing::Failure begin_due(HomingDrive &drive, const HomeConditions &conditions) noexcept;
struct HomingFailure {
    int joint = -1;  ///< -1: none
    homing::Failure why = homing::Failure::NONE;
};
/// What has failed in this cycle by itself; not what was aborted.
HomingFailure take_failure(HomingDrive &drive) noexcept;
/// Whether each command of a foreign module is one that a joint can be given; ends homing where one is not.
bool areFinite(const HomingDrive &drive, const homing::JointCommand *commands) noexcept;

void fill(const HomingDrive &drive, Outputs &out) noexcept;

}  // namespace mw::motion

// SPDX-License-Identifier: GPL-2.0-or-later
// Homing as a command: it begins when the jogs that it has stopped are at rest, and tells once what has
// failed.
#pragma once

#include <array>
#include <cstdint>

#include "homing/homing.hh"
#include "motion/api/command.hh"
#include "motion/api/settings.hh"
#include "motion/core/io.hh"
#include "motion/core/verdict.hh"

namespace mw::motion {

struct HomingDrive {
    homing::Homing homing;
    int num_joints = 0;
    bool isDue = false;
    int due = -1;  ///< the joint, -1: all

    /// Or about to begin.
    bool isUnderWay() const noexcept { return homing.isActive() || isDue; }
};

/// Bit per homed joint: soft limits hold from there on.
std::uint32_t homed_mask(const HomingDrive &drive) noexcept;

struct HomeConditions {
    bool isReady = false;  ///< machine on, no stop under way
    Mode mode = Mode::FREE;
    bool isInhibited = false, isMoving = false;
};
/// Done means asked for: whatever is jogged is to be brought to rest.
Verdict take(HomingDrive &drive, const Home &command, const HomeConditions &conditions) noexcept;
Verdict take(HomingDrive &drive, const Unhome &command, const HomeConditions &conditions,
             const Settings &settings) noexcept;

/// Takes the settings of joint j.
void configure(HomingDrive &drive, int j, const Settings &settings) noexcept;
void abort(HomingDrive &drive, homing::Failure why) noexcept;
/// Switched off: joints with a volatile home lose it.
void switch_off(HomingDrive &drive, const Settings &settings) noexcept;

/// A cycle before the joints move: homing that is due begins when nothing moves.
void begin_due(HomingDrive &drive, bool isMoving) noexcept;
struct HomingFailure {
    int joint = -1;  ///< -1: none
    homing::Failure why = homing::Failure::NONE;
};
/// What has failed in this cycle by itself; not what was aborted.
HomingFailure take_failure(HomingDrive &drive) noexcept;

void fill(const HomingDrive &drive, Outputs &out) noexcept;

}  // namespace mw::motion

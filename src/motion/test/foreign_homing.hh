// SPDX-License-Identifier: GPL-2.0-or-later
// A homing module of a user, for tests.
#pragma once

#include "motion/homing/module.hh"

namespace mw::motion {

/// Its joint homes until it is ended or fails. The module reports whether it has work.
struct ForeignModule final : homing::Module {
    bool isBusy = false, areHomed = false;
    int steps = 0;  ///< cycles in which the module was called for moves
    void set_num_joints(int) noexcept override {}
    void configure(int, const homing::Parameters &) noexcept override {}
    void start(int) noexcept override { isBusy = true; }
    void abort(homing::event::Event, int) noexcept override { isBusy = false; }
    void unhome(int) noexcept override {}
    void step(const homing::JointInput *, homing::JointCommand *) noexcept override { ++steps; }
    bool isHoming(int) const noexcept override { return isBusy; }
    bool isHomed(int) const noexcept override { return areHomed; }
    bool isActive() const noexcept override { return isBusy; }
    bool hasWork() const noexcept override { return isBusy; }
    int step_number(int) const noexcept override { return 0; }
    bool isIndexWanted(int) const noexcept override { return false; }
    bool isAtIndex(int) const noexcept override { return false; }
    bool isUnlockWanted(int) const noexcept override { return false; }
    int take_failure(homing::Failure &) noexcept override { return -1; }
    void lock() noexcept override {}
};

}  // namespace mw::motion

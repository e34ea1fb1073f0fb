// SPDX-License-Identifier: GPL-2.0-or-later
#include "motion/servo/indexers/indexers.hh"

#include <bit>

namespace mw::motion {
namespace {

struct LockStep {
    LockState state = LockState::LOCKED;
    LockFault fault = LockFault::NONE;
};

struct LockSituation {
    bool isWanted = false, isMoving = false, isUnlocked = false, isOverdue = false;
};

LockStep next(LockState state, const LockSituation &s) noexcept {
    switch (state) {
    case LockState::LOCKED: return {s.isWanted ? LockState::UNLOCKING : LockState::LOCKED};
    case LockState::UNLOCKING:
        if (!s.isWanted) {
            return {LockState::LOCKING};
        }
        if (s.isUnlocked) {
            return {LockState::UNLOCKED};
        }
        return s.isOverdue ? LockStep{LockState::LOCKING, LockFault::NOT_UNLOCKED} : LockStep{state};
    case LockState::UNLOCKED:
        if (!s.isUnlocked && (s.isWanted || s.isMoving)) {
            return {LockState::LOCKING, LockFault::LOCKED_IN_MOVE};
        }
        return {s.isWanted || s.isMoving ? LockState::UNLOCKED : LockState::LOCKING};
    case LockState::LOCKING:
        // It is unlocked again only after it has locked, because is-unlocked may have its old value.
        if (!s.isUnlocked) {
            return {LockState::LOCKED};
        }
        return s.isOverdue ? LockStep{LockState::STUCK, LockFault::NOT_LOCKED} : LockStep{state};
    case LockState::STUCK:
        if (!s.isUnlocked) {
            return {LockState::LOCKED};
        }
        return {s.isWanted ? LockState::UNLOCKING : LockState::STUCK};
    }
    return {};
}

std::size_t at(int joint) noexcept {
    return static_cast<std::size_t>(joint);
}

}  // namespace

IndexerEvent Indexers::step(const IndexerInputs &in) noexcept {
    IndexerEvent event;
    homing_ = in.homing;
    for (std::uint32_t left = joints_; left != 0; left &= left - 1) {
        const int j = std::countr_zero(left);
        const std::uint32_t bit = 1U << j;
        LockState &state = state_[at(j)];
        if ((in.homing & bit) != 0) {
            state = LockState::LOCKED;
            continue;
        }
        int &wait = wait_[at(j)];
        LockSituation s;
        s.isWanted = (in.wanted & bit) != 0;
        s.isMoving = (in.moving & bit) != 0;
        s.isUnlocked = (in.unlocked & bit) != 0;
        s.isOverdue = wait * in.period_s >= LONGEST_LOCK_S;
        const LockStep then = next(state, s);
        wait = then.state == state && !s.isOverdue ? wait + 1 : 0;
        state = then.state;
        event = then.fault != LockFault::NONE ? IndexerEvent{then.fault, j} : event;
    }
    return event;
}

void Indexers::switch_off() noexcept {
    state_.fill(LockState::LOCKED);
    wait_.fill(0);
}

void Indexers::switch_on(std::uint32_t unlocked) noexcept {
    switch_off();
    for (std::uint32_t open = joints_ & unlocked; open != 0; open &= open - 1) {
        state_[at(std::countr_zero(open))] = LockState::LOCKING;
    }
}

std::uint32_t Indexers::in_state(LockState state) const noexcept {
    std::uint32_t out = 0;
    for (std::uint32_t left = joints_; left != 0; left &= left - 1) {
        const int j = std::countr_zero(left);
        out |= state_[at(j)] == state ? 1U << j : 0U;
    }
    return out;
}

std::uint32_t Indexers::held() const noexcept {
    return joints_ & ~in_state(LockState::UNLOCKED) & ~homing_;
}

std::uint32_t Indexers::busy() const noexcept {
    return joints_ & ~in_state(LockState::LOCKED) & ~in_state(LockState::STUCK);
}

void Indexers::fill(Outputs &out) const noexcept {
    for (std::uint32_t left = joints_; left != 0; left &= left - 1) {
        const int j = std::countr_zero(left);
        const LockState state = state_[at(j)];
        out.joint[at(j)].isUnlockWanted =
            out.joint[at(j)].isUnlockWanted || state == LockState::UNLOCKING || state == LockState::UNLOCKED;
    }
}

std::uint32_t unlocked_pins(const Inputs &in) noexcept {
    std::uint32_t out = 0;
    for (std::size_t j = 0; j < MAX_JOINTS; ++j) {
        out |= in.joint[j].isUnlocked ? 1U << j : 0U;
    }
    return out;
}

}  // namespace mw::motion

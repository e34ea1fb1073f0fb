// SPDX-License-Identifier: GPL-2.0-or-later
// Locking indexers: joints that are locked except during their own moves. Before a jog or G0 of such a joint
// it is unlocked, and locked after it; homing does this by itself. A joint moves only while it is unlocked.
#pragma once

#include <array>
#include <cstdint>

#include "base/limits.hh"
#include "motion/servo/io.hh"

namespace mw::motion {

enum class LockState : std::uint8_t {
    LOCKED,
    UNLOCKING,  ///< requested, not yet unlocked
    UNLOCKED,   ///< it may move
    LOCKING,    ///< requested, not yet locked
    STUCK,      ///< it has not locked in time
};

struct Indexers {
    std::uint32_t mask = 0;    ///< bit per joint that has a lock
    std::uint32_t homing = 0;  ///< joints that are being homed
    std::array<LockState, MAX_JOINTS> state{};
    std::array<int, MAX_JOINTS> wait{};  ///< cycles in this state
};

/// Maximum time of locking or unlocking [s].
inline constexpr double LONGEST_LOCK_S = 30;

/// Bits per joint.
struct IndexerInputs {
    std::uint32_t wanted = 0;    ///< a move of it is requested
    std::uint32_t moving = 0;    ///< it moves
    std::uint32_t unlocked = 0;  ///< by its pin
    std::uint32_t homing = 0;    ///< it is being homed
    double period_s = 1e-3;
};
enum class LockFault : std::uint8_t { NONE, NOT_UNLOCKED, NOT_LOCKED, LOCKED_IN_MOVE };
struct IndexerEvent {
    LockFault fault = LockFault::NONE;
    int joint = -1;
};
/// One cycle while the machine is on, before anything moves.
IndexerEvent step(Indexers &indexers, const IndexerInputs &in) noexcept;

/// All lock at once: the machine goes off.
void switch_off(Indexers &indexers) noexcept;
/// Switched on: state from the pins.
void switch_on(Indexers &indexers, const IndexerInputs &in) noexcept;

/// Joints that may not be moved now.
std::uint32_t held(const Indexers &indexers) noexcept;
/// Joints that wait for their lock, or move.
[[gnu::hot]] std::uint32_t busy(const Indexers &indexers) noexcept;
std::uint32_t in_state(const Indexers &indexers, LockState state) noexcept;

void fill(const Indexers &indexers, Outputs &out) noexcept;

/// The pins is-unlocked as bits.
std::uint32_t unlocked_pins(const Inputs &in) noexcept;

}  // namespace mw::motion

// SPDX-License-Identifier: GPL-2.0-or-later
// Locking indexers are locked except during their own moves. A jog or G0 of such a joint unlocks it before
// and locks it after the move; homing does the same. A joint moves only while it is unlocked.
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

/// Maximum time of locking or unlocking [s].
inline constexpr double LONGEST_LOCK_S = 30;

/// Bits per joint.
struct IndexerInputs {
    std::uint32_t wanted = 0;    ///< a move of this joint is requested
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
class Indexers {
  public:
    /// Bit per joint that has a lock.
    void set_joints(std::uint32_t joints) noexcept { joints_ = joints; }
    bool isEmpty() const noexcept { return joints_ == 0; }

    /// One cycle while the machine is on, before joints move.
    IndexerEvent step(const IndexerInputs &in) noexcept;
    /// Locks all indexers at once, because the machine is switched off.
    void switch_off() noexcept;
    /// Called when the machine is switched on. `unlocked`: bit per joint, from the pins.
    void switch_on(std::uint32_t unlocked) noexcept;

    /// Joints that may not be moved now.
    std::uint32_t held() const noexcept;
    /// Joints that wait for their lock, or are moving.
    [[gnu::hot]] std::uint32_t busy() const noexcept;
    std::uint32_t in_state(LockState state) const noexcept;

    void fill(Outputs &out) const noexcept;

  private:
    std::uint32_t joints_ = 0;
    std::uint32_t homing_ = 0;  ///< joints that are being homed
    std::array<LockState, MAX_JOINTS> state_{};
    std::array<int, MAX_JOINTS> wait_{};  ///< cycles in this state
};

/// The pins is-unlocked as bits.
std::uint32_t unlocked_pins(const Inputs &in) noexcept;

}  // namespace mw::motion

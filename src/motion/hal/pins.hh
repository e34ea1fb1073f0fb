// SPDX-License-Identifier: GPL-2.0-or-later
// The HAL pins of the motion controller, declared in motion/hal/pin_tables.hh: one set of each table for each
// joint, axis and spindle of the machine.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "base/limits.hh"
#include "motion/hal/pin_tables.hh"

namespace mw::motion {

struct PinCounts {
    int joints = MAX_JOINTS;
    int spindles = 1;
    int digital = 4, analog = 4, misc_errors = 0;
    int unlock_mask = 0;
    int extra_joints = 0;            ///< the last ones
    bool isSwitchable = false;       ///< kinematics of several types
    bool areHomingPinsMade = false;  ///< by a homing module
};

/// Is in HAL memory.
class MotionPins {
  public:
    /// Creates the pins. Returns 0 or a negated errno. [while loading]
    int declare(int comp_id, const PinCounts &wanted) noexcept;
    /// [servo]
    [[gnu::hot]] void read(Inputs &in) noexcept;
    /// [servo]
    [[gnu::hot]] void write(const Outputs &out) noexcept;

  private:
    bool isUnlockable(int joint) const noexcept {
        return (static_cast<unsigned>(counts_.unlock_mask) >> joint & 1U) != 0;
    }

    /// Pin values that seldom change, as words.
    template <std::size_t BYTES>
        requires(BYTES % 8 == 0)
    using Shown = std::array<std::uint64_t, BYTES / 8>;
    static constexpr std::size_t FLAGS = offsetof(JointStatus, isActive);  ///< from here to the end

    bool areLinksOther() noexcept;

    PinCounts counts_;
    std::uint32_t axes_ = ALL_AXES;                  ///< as Outputs::axes
    const std::uint32_t *links_ = nullptr;           ///< HAL's count of pin connections
    const std::uint32_t *lost_positions_ = nullptr;  ///< as Inputs::lost_positions
    std::uint32_t last_links_ = 0;
    std::uint32_t last_axes_ = 0;  ///< 0: all are written in the first cycle
    std::array<Shown<sizeof(SeldomJointOutputs)>, MAX_JOINTS> joint_shown_{};
    std::array<Shown<sizeof(JointStatus) - FLAGS>, MAX_JOINTS> flags_shown_{};
    std::array<Shown<sizeof(SeldomAxisOutputs)>, MAX_AXES> axis_shown_{};
    sdk::PinSet<pins::MOTION> motion_;
    sdk::PinSet<pins::SWITCHABLE> switchable_;
    sdk::PinSet<pins::DIGITAL> digital_[MAX_DIGITAL_IO];
    sdk::PinSet<pins::ANALOG> analog_[MAX_ANALOG_IO];
    sdk::PinSet<pins::MISC_ERROR> misc_error_[MAX_DIGITAL_IO];
    sdk::PinSet<pins::JOINT> joint_[MAX_JOINTS];
    sdk::PinSet<pins::SELDOM_JOINT> seldom_joint_[MAX_JOINTS];
    sdk::PinSet<pins::HOMING> homing_[MAX_JOINTS];
    sdk::PinSet<pins::SELDOM_HOMING> seldom_homing_[MAX_JOINTS];
    sdk::PinSet<pins::UNLOCK> unlock_[MAX_JOINTS];
    sdk::PinSet<pins::POSTHOME> posthome_[MAX_JOINTS];
    sdk::PinSet<pins::AXIS> axis_[MAX_AXES];
    sdk::PinSet<pins::SELDOM_AXIS> seldom_axis_[MAX_AXES];
    sdk::PinSet<pins::SPINDLE> spindle_[MAX_SPINDLES];
    std::int64_t last_time_ns_ = 0;
};

}  // namespace mw::motion

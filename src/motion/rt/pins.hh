// SPDX-License-Identifier: GPL-2.0-or-later
// The HAL pins of the motion controller: one set of each table of motion/rt/pin_tables.hh for what the
// machine has.
#pragma once

#include <cstdint>

#include "base/limits.hh"
#include "motion/rt/pin_tables.hh"

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

/// Lives in HAL memory.
class MotionPins {
  public:
    /// Makes the pins; 0 or a negated errno. [while loading]
    int declare(int comp_id, const PinCounts &wanted) noexcept;
    /// [servo]
    void read(Inputs &in) noexcept;
    /// [servo]
    void write(const Outputs &out) noexcept;

  private:
    bool isUnlockable(int joint) const noexcept {
        return (static_cast<unsigned>(counts_.unlock_mask) >> joint & 1U) != 0;
    }

    PinCounts counts_;
    std::uint32_t axes_ = ALL_AXES;  ///< as Outputs::axes
    sdk::PinSet<pins::MOTION> motion_;
    sdk::PinSet<pins::SWITCHABLE> switchable_;
    sdk::PinSet<pins::DIGITAL> digital_[MAX_DIGITAL_IO];
    sdk::PinSet<pins::ANALOG> analog_[MAX_ANALOG_IO];
    sdk::PinSet<pins::MISC_ERROR> misc_error_[MAX_DIGITAL_IO];
    sdk::PinSet<pins::TOOL_OFFSET> tool_offset_[MAX_AXES];
    sdk::PinSet<pins::JOINT> joint_[MAX_JOINTS];
    sdk::PinSet<pins::HOMING> homing_[MAX_JOINTS];
    sdk::PinSet<pins::UNLOCK> unlock_[MAX_JOINTS];
    sdk::PinSet<pins::POSTHOME> posthome_[MAX_JOINTS];
    sdk::PinSet<pins::AXIS> axis_[MAX_AXES];
    sdk::PinSet<pins::SPINDLE> spindle_[MAX_SPINDLES];
    std::int64_t last_time_ns_ = 0;
};

}  // namespace mw::motion

// SPDX-License-Identifier: GPL-2.0-or-later
// Joints: feedback, faults, following error, corrections, offsets and motor positions.
#pragma once

#include <array>
#include <cstdint>

#include "base/limits.hh"
#include "motion/interface/command.hh"
#include "motion/interface/limits.hh"
#include "motion/interface/settings.hh"
#include "motion/servo/command_result.hh"
#include "motion/servo/io.hh"
#include "motion/servo/joints/correction.hh"

namespace mw::motion {

struct Joint {
    bool isActive = true;
    bool isAmpWanted = false;  ///< amplifier enable while the machine is on
    bool isFaulted = false, isFerrorTripped = false;
    bool isFeedbackLost = false;  ///< the pin has no number; the feedback is the last valid value
    bool isOnPosHardLimit = false, isOnNegHardLimit = false;
    double pos_cmd = 0, pos_fb = 0, vel_cmd = 0, acc_cmd = 0;
    double coarse_pos = 0;
    double motor_pos_cmd = 0, motor_pos_fb = 0, motor_offset = 0;
    double ferror = 0, ferror_limit = 0, ferror_highmark = 0;
    Correction correction;
};

/// One value per joint; 0 for joints that the machine does not have.
using PerJoint = std::array<double, MAX_JOINTS>;

struct ActivationConditions {
    bool isMoving = false, isHoming = false;
    bool areJointsAlone = true;  ///< off, or in free mode: no pose commands the joints
};
enum class JointFault : std::uint8_t { NONE, FEEDBACK_LOST, AMP_FAULT, FOLLOWING_ERROR, HARD_LIMIT };
struct JointCheck {
    /// Bit per joint whose encoder is reset in this cycle: command and feedback have different zeros.
    std::uint32_t at_index = 0;
    std::uint32_t limits_ignored = 0;    ///< bit per joint
    std::uint32_t feedback_ignored = 0;  ///< the same
};
/// Commands the joint to `position` at the end of this cycle; inactive joints get no command.
inline void follow(Joint &joint, double position, double period_s) noexcept {
    if (!joint.isActive) {
        return;
    }
    const double v = (position - joint.pos_cmd) / period_s;
    joint.acc_cmd = (v - joint.vel_cmd) / period_s;
    joint.vel_cmd = v;
    joint.pos_cmd = position;
    joint.coarse_pos = position;
}

/// The joint that exceeds its limits or leaves its soft limits, -1: none.
struct Overrun {
    int joint = -1;
    bool isOutside = false;
    double use = 0;  ///< use of the speed or acceleration limit, 1 for all of it
};

struct JointSituation {
    bool isEnabled = false, areLimitsOverridden = false;
    bool isHomed = false;
};
/// Situation of all joints.
struct JointsSituation {
    bool isEnabled = false, areLimitsOverridden = false;
    std::uint32_t homed = 0;  ///< bit per joint
};
/// Pins and status of a joint; its limits are already in `status`.
void fill(const Joint &joint, const JointSituation &situation, JointStatus &status,
          JointOutputs &outputs) noexcept;

/// The joints of the machine: the joints in use are the first of the loaded ones.
class Joints {
  public:
    explicit Joints(int loaded) noexcept : loaded_(loaded) {}

    void use_joints(int count) noexcept { count_ = count; }
    /// In use.
    int count() const noexcept { return count_; }
    /// Number of joints that may be used.
    int loaded() const noexcept { return loaded_; }
    const Joint &operator[](int j) const noexcept { return joint_[static_cast<std::size_t>(j)]; }
    /// Commanded positions.
    PerJoint commanded() const noexcept;
    /// Bit per inactive joint.
    std::uint32_t inactive() const noexcept;

    CommandResult take(const SetAmplifier &command, bool isEnabled) noexcept;
    /// Only while the machine is off, because the correction could move a joint.
    CommandResult take(const LoadCompensation &command, bool isEnabled) noexcept;
    CommandResult take(const SetJointActive &command, const ActivationConditions &conditions) noexcept;
    /// Deactivates the joint until it is activated.
    void deactivate(int j) noexcept { at(j).isActive = false; }
    /// Reason why the machine may not be switched on, NONE if it may.
    CommandResult check_start(const Inputs &in, bool areLimitsOverridden) const noexcept;
    /// Switches on: the feedback becomes the command.
    void switch_on() noexcept;
    void switch_off() noexcept;

    /// Returns the measured positions.
    [[gnu::hot]] PerJoint read_feedback(const Inputs &in) noexcept;
    /// Following error, amplifier and limit switches of the active joints from `joint` on, up to the first
    /// fault; `joint` is set to its joint.
    JointFault find_fault(int &joint, const Settings &settings, const JointCheck &how) noexcept;
    Overrun find_overrun(const FoldedLimits &limits) const noexcept;

    /// Commands joint j to `position` at the end of this cycle; inactive joints get no command.
    void follow(int j, double position, double period_s) noexcept {
        motion::follow(at(j), position, period_s);
    }
    /// Homing has found the zero: positions change by `shift`; the motor does not move.
    void shift(int j, double shift) noexcept;
    /// The encoder was just reset: motor position 0 is joint position `zero`.
    void set_zero(int j, double zero) noexcept;
    /// Motor positions: with corrections and offset while on, the feedback while off. Returns a bit per joint
    /// that is off.
    [[gnu::hot]] std::uint32_t output(const Settings &settings, bool isEnabled, double period_s) noexcept;

    void fill(const JointsSituation &situation, Outputs &out) const noexcept;

  private:
    bool hasJoint(int j) const noexcept { return j >= 0 && j < count_; }
    Joint &at(int j) noexcept { return joint_[static_cast<std::size_t>(j)]; }

    int count_ = 0;
    int loaded_;
    std::array<Joint, MAX_JOINTS> joint_;
};

}  // namespace mw::motion

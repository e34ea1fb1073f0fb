// SPDX-License-Identifier: GPL-2.0-or-later
#include "motion/servo/safety_monitor.hh"

#include "motion/servo/motion_mode.hh"

namespace mw::motion {
namespace {

/// Selects the joints to which each check applies.
JointCheck joint_check(const ControllerParts &parts, const Inputs &in) noexcept {
    const HomingDrive &homing = parts.homing;
    JointCheck how;
    how.limits_ignored = parts.jogs.areLimitsOverridden() ? ~0U : 0U;
    how.feedback_ignored = parts.extra.mask() & parts.model.limits().homed.joints;
    if (parts.homing.hasWork()) [[unlikely]] {
        for (int j = 0; j < parts.model.num_joints(); ++j) {
            const bool isIndexFound = !in.joint[static_cast<std::size_t>(j)].isIndexEnabled;
            how.at_index |= homing.isAtIndex(j) && isIndexFound ? 1U << j : 0U;
            how.limits_ignored |= parts.homing.isIgnoringLimits(j) ? 1U << j : 0U;
        }
    }
    return how;
}

/// Checks amplifier, following error and limit switches of each joint.
void check_joints(ControllerParts &parts, const Inputs &in) noexcept {
    Joints &joints = parts.joints;
    const JointCheck how = joint_check(parts, in);
    for (int j = 0; parts.power.isEnabled(); ++j) {
        switch (joints.find_fault(j, parts.model.settings(), how)) {
        case JointFault::NONE: return;
        case JointFault::FEEDBACK_LOST: parts.stop_category_0(FaultKind::FEEDBACK_LOST, j); break;
        case JointFault::AMP_FAULT: parts.stop_category_0(FaultKind::AMP_FAULT, j); break;
        case JointFault::FOLLOWING_ERROR:
            parts.stop_category_0(FaultKind::FOLLOWING_ERROR, j, joints[j].ferror);
            break;
        case JointFault::HARD_LIMIT:
            if (parts.homing.isHoming(j)) {
                parts.homing.abort(homing::event::LIMIT, j);
            }
            parts.stop_category_1(FaultKind::HARD_LIMIT, j, joints[j].isOnPosHardLimit ? 1.0 : -1.0);
            break;
        }
    }
}

void check_spindles(ControllerParts &parts, const Inputs &in, std::uint32_t spindles_lost) noexcept {
    const int in_step = parts.executor.locked_spindle();
    for (int n = 0; n < parts.model.num_spindles(); ++n) {
        if (in.spindle[static_cast<std::size_t>(n)].isAmpFaulted) [[unlikely]] {
            parts.stop_category_1(FaultKind::SPINDLE_FAULT, n);
        }
        if (n == in_step && (spindles_lost >> n & 1U) != 0) [[unlikely]] {
            parts.stop_category_1(FaultKind::SPINDLE_LOST, n);
        }
    }
}

}  // namespace

void SafetyMonitor::step(ControllerParts &parts, const Inputs &in, std::uint32_t spindles_lost) noexcept {
    check_positions(parts, in.lost_positions);
    check_task(parts);
    check_servo_thread(parts, in.time_ns);
    if (!parts.power.isEnabled()) [[unlikely]] {
        return;
    }
    if (!in.isEnableOn) [[unlikely]] {
        parts.stop_category_0(FaultKind::ENABLE_LOST, -1);
        return;
    }
    check_joints(parts, in);
    check_spindles(parts, in, spindles_lost);
    if (in.misc_errors != 0) [[unlikely]] {
        parts.stop_category_1(FaultKind::MISC_ERROR, -1, static_cast<double>(in.misc_errors));
    }
}

/// The feedback does not match the machine, so braking to a position would also be wrong.
void SafetyMonitor::check_positions(ControllerParts &parts, std::uint32_t lost_positions) noexcept {
    if (parts.homing.note_lost_positions(lost_positions)) [[unlikely]] {
        if (parts.power.isEnabled() || parts.homing.homed_joints() != 0) {
            parts.raise(FaultKind::POSITIONS_LOST, -1);
        }
        parts.switch_off();
    }
}

void SafetyMonitor::check_task(ControllerParts &parts) noexcept {
    const Channels &channels = *parts.channels;
    const TaskSigns signs{channels.task_loops.load(std::memory_order_relaxed),
                          channels.host_looks.load(std::memory_order_relaxed),
                          channels.isTaskDead.load(std::memory_order_acquire) != 0};
    if (watchdog_.step(signs, parts.model.period_s())) [[unlikely]] {
        parts.stop_category_1(FaultKind::TASK_LOST, signs.isDead ? 1 : 0, watchdog_.silent_s());
    }
}

/// Drives and step generators have kept their last command, so continuing from there would cause a jump.
void SafetyMonitor::check_servo_thread(ControllerParts &parts, std::int64_t time_ns) noexcept {
    const double missed_s = watchdog_.gap_s(time_ns);
    if (missed_s > 0 && parts.power.isEnabled()) [[unlikely]] {
        isAnythingMoving(parts) ? parts.stop_category_0(FaultKind::MOTION_STOOD, 1, missed_s)
                                : parts.raise(FaultKind::MOTION_STOOD, 0, missed_s);
    }
}

void finish_stop(ControllerParts &parts) noexcept {
    if (parts.power.isStopping() && !isAnythingMoving(parts) && parts.offsets.isAtRest() &&
        parts.extra.areAtRest()) [[unlikely]] {
        parts.switch_off();
    }
}

}  // namespace mw::motion

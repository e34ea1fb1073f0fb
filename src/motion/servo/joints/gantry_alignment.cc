// SPDX-License-Identifier: GPL-2.0-or-later
#include "motion/servo/joints/gantry_alignment.hh"

#include <algorithm>
#include <bit>
#include <cmath>

namespace mw::motion {

namespace {

/// Rounding of a position [machine units, degrees].
constexpr double ROUNDING = 1e-6;

bool isMisplaced(const Joint &joint, double target, double tolerance) noexcept {
    return joint.isActive && !(std::abs(joint.pos_cmd - target) <= tolerance);
}

}  // namespace

int find_misaligned_joint(const Joints &joints, const PerJoint &targets, const Settings &settings) noexcept {
    for (int j = 0; j < joints.count(); ++j) {
        const double tolerance = std::max(settings.get(Parameter::JOINT_MIN_FERROR, j), ROUNDING);
        if (isMisplaced(joints[j], targets[static_cast<std::size_t>(j)], tolerance)) {
            return j;
        }
    }
    return -1;
}

void GantryAlignment::begin(const Joints &joints, const PerJoint &targets,
                            const FoldedLimits &limits) noexcept {
    cancel();
    for (int j = 0; j < joints.count(); ++j) {
        const auto n = static_cast<std::size_t>(j);
        if (isMisplaced(joints[j], targets[n], ROUNDING)) {
            trajectory::AxisMotion &p = planner_[n];
            p.reset(joints[j].pos_cmd);
            p.target = targets[n];
            p.max_velocity = limits.joint_jog[n].velocity;
            p.max_acceleration = limits.joint_jog[n].acceleration;
            p.max_jerk = limits.joint_jog[n].jerk;
            joints_ |= 1U << j;
        }
    }
}

void GantryAlignment::stop() noexcept {
    if (isMoving()) {
        stopping_ = true;
        for (trajectory::AxisMotion &p : planner_) {
            p.stop();
        }
    }
}

void GantryAlignment::cancel() noexcept {
    joints_ = 0;
    active_ = stopping_ = false;
}

AlignmentStep GantryAlignment::step(Joints &joints, bool isMotionWanted, double period_s) noexcept {
    active_ = active_ || isMotionWanted;
    if (!active_) {
        return AlignmentStep::CONTINUES;
    }
    for (std::uint32_t left = joints_; left != 0; left &= left - 1) {
        const int j = std::countr_zero(left);
        trajectory::AxisMotion &p = planner_[static_cast<std::size_t>(j)];
        p.step(period_s);
        joints.follow(j, p.position, period_s);
        joints_ &= p.isAtRest() ? ~(1U << j) : ~0U;
    }
    const bool hasStopped = stopping_ && !isMisaligned();
    if (!isMisaligned()) {
        cancel();
    }
    return hasStopped ? AlignmentStep::STOPPED : AlignmentStep::CONTINUES;
}

}  // namespace mw::motion

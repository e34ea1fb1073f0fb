// SPDX-License-Identifier: GPL-2.0-or-later
#include "motion/servo/joints/gantry_alignment.hh"

#include <algorithm>
#include <bit>
#include <cmath>

namespace mw::motion {

namespace {

/// Rounding of a position [machine units, degrees].
constexpr double ROUNDING = 1e-6;

bool isApart(const Joint &joint, double led, double most) noexcept {
    return joint.isActive && !(std::abs(joint.pos_cmd - led) <= most);
}

}  // namespace

int find_misaligned_joint(const Joints &joints, const PerJoint &led, const Settings &settings) noexcept {
    for (int j = 0; j < joints.count; ++j) {
        const double most = std::max(settings.get(Parameter::JOINT_MIN_FERROR, j), ROUNDING);
        if (isApart(joints[j], led[static_cast<std::size_t>(j)], most)) {
            return j;
        }
    }
    return -1;
}

void begin(GantryAlignment &sides, const Joints &joints, const PerJoint &led,
           const FoldedLimits &limits) noexcept {
    forget(sides);
    for (int j = 0; j < joints.count; ++j) {
        const auto n = static_cast<std::size_t>(j);
        if (isApart(joints[j], led[n], ROUNDING)) {
            trajectory::AxisMotion &p = sides.planner[n];
            p.reset(joints[j].pos_cmd);
            p.target = led[n];
            p.max_velocity = limits.joint_jog[n].velocity;
            p.max_acceleration = limits.joint_jog[n].acceleration;
            p.max_jerk = limits.joint_jog[n].jerk;
            sides.joints |= 1U << j;
        }
    }
}

void stop(GantryAlignment &sides) noexcept {
    if (sides.areUnderWay()) {
        sides.isStopping = true;
        for (trajectory::AxisMotion &p : sides.planner) {
            p.stop();
        }
    }
}

void forget(GantryAlignment &sides) noexcept {
    sides.joints = 0;
    sides.isActive = sides.isStopping = false;
}

AlignmentStep step(GantryAlignment &sides, Joints &joints, bool isMotionWanted, double period_s) noexcept {
    sides.isActive = sides.isActive || isMotionWanted;
    if (!sides.isActive) {
        return AlignmentStep::GOES_ON;
    }
    for (std::uint32_t left = sides.joints; left != 0; left &= left - 1) {
        const int j = std::countr_zero(left);
        trajectory::AxisMotion &p = sides.planner[static_cast<std::size_t>(j)];
        p.step(period_s);
        follow(joints[j], p.position, period_s);
        sides.joints &= p.isAtRest() ? ~(1U << j) : ~0U;
    }
    const bool hasStopped = sides.isStopping && !sides.isMisaligned();
    if (!sides.isMisaligned()) {
        forget(sides);
    }
    return hasStopped ? AlignmentStep::STOPPED : AlignmentStep::GOES_ON;
}

}  // namespace mw::motion

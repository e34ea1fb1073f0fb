// SPDX-License-Identifier: GPL-2.0-or-later
#include "motion/servo/jog_stage.hh"

#include "motion/servo/motion_mode.hh"

namespace mw::motion {
namespace {

/// An indexer is jogged only while nothing else moves, and nothing else moves while it is jogged.
bool isBesideIndexer(const ControllerParts &parts, const JogTarget &target) noexcept {
    const FoldedLimits &limits = parts.model.limits();
    const std::uint32_t own = limits.locks_of(target);
    bool is = (parts.indexers.busy() & ~own) != 0;
    const int count = target.isJoint ? parts.jogs.num_joints() : MAX_AXES;
    for (int i = 0; i < count; ++i) {
        const JogTarget other{target.isJoint, i};
        const bool areOne = own != 0 && (limits.locks_of(other) & own) != 0;
        const bool isLone = own != 0 || limits.locks_of(other) != 0;
        const bool isMoving = !parts.jogs.at(other).isAtRest();
        is = is || (i != target.index && !areOne && isLone && isMoving);
    }
    return is;
}

/// Range of a jog of `target`.
JogRange range_of(const ControllerParts &parts, const JogTarget &target) noexcept {
    JogRange range =
        jog_range(parts.model.limits(), parts.model.map(), target, parts.joints.commanded().data());
    if (!target.isJoint) {
        parts.offsets.narrow(range, target.index);
    }
    return range;
}

}  // namespace

JogSituation jog_situation(const ControllerParts &parts, const Inputs &in, const JogTarget &target) noexcept {
    JogSituation s;
    if (!parts.jogs.hasTarget(target)) {
        return s;
    }
    const FoldedLimits &limits = parts.model.limits();
    const AxisMap &map = parts.model.map();
    s.time_ns = in.time_ns;
    s.isReady = parts.power.isReady();
    s.mode = parts.power.mode();
    s.isHoming = parts.homing.isUnderWay();
    s.isInhibited = in.isJogInhibited || in.isJogStopped || in.isJogStoppedNow;
    s.isDriven = target.isJoint && (parts.extra.mask() & limits.homed.joints & 1U << target.index) != 0;
    s.isMovable = target.isJoint ? parts.joints[target.index].isActive : map.hasAxis(target.index);
    if (target.isJoint) {
        const Joint &joint = parts.joints[target.index];
        const double sequence = parts.model.settings().get(Parameter::JOINT_HOME_SEQUENCE, target.index);
        s.isSynchronised = sequence < 0 && sequence > -100;
        s.isOnPosLimit = joint.isOnPosHardLimit;
        s.isOnNegLimit = joint.isOnNegHardLimit;
    }
    s.isLocked = limits.locks_of(target) != 0;
    s.isShared = !target.isJoint && !map.areJointsAxes();
    s.isBesideIndexer = !parts.indexers.isEmpty() && isBesideIndexer(parts, target);
    s.limits = limits.jog(target);
    s.range = range_of(parts, target);
    return s;
}

void keep_jogs_within_limits(ControllerParts &parts) noexcept {
    for (int j = 0; j < parts.model.num_joints(); ++j) {
        parts.jogs.at({true, j}).keep_within(range_of(parts, {true, j}));
    }
    for (int i = 0; i < MAX_AXES; ++i) {
        parts.jogs.at({false, i}).keep_within(range_of(parts, {false, i}));
    }
}

/// Jogs whose lease is not renewed stop, also if task and client have ended.
void step_jogs(ControllerParts &parts, const Inputs &in) noexcept {
    Jogs &jogs = parts.jogs;
    for (JogTarget over = jogs.end_lease(in.time_ns); over.index >= 0; over = jogs.end_lease(in.time_ns)) {
        const auto lease_ns = static_cast<double>(jogs.at(over).lease().length_ns);
        parts.raise(FaultKind::JOG_LEASE_ENDED, over.index, lease_ns * 1e-9, over.isJoint ? 1 : 0);
    }
    if (in.isJogStoppedNow) [[unlikely]] {
        jogs.stop_at_once();
    } else if (in.isJogStopped && !parts.homing.isActive()) [[unlikely]] {
        jogs.stop();
    }
    const JogGroup group = motion_mode(parts.power.mode()).jog_group(parts);
    for (int i = 0; i < group.count; ++i) {
        const JogTarget target{group.areJoints, i};
        const auto n = static_cast<std::size_t>(i);
        const WheelInput &wheel = group.areJoints ? in.joint[n].wheel : in.axis_wheel[n];
        const double distance = jogs.at(target).turned(wheel);
        if (distance != 0.0) [[unlikely]] {
            jogs.jog_by_wheel(target, distance, wheel, jog_situation(parts, in, target));
        }
    }
    jogs.settle(in);
}

}  // namespace mw::motion

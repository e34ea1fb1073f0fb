// SPDX-License-Identifier: GPL-2.0-or-later
#include "motion/core/coord/retracing.hh"

#include <algorithm>
#include <cmath>

namespace mw::motion {

namespace {

std::size_t at(int i) noexcept {
    return static_cast<std::size_t>(i);
}

/// A path that is dropped while it is gone back ends where that comes to a stand.
void follow_drops(Retracing &r, std::uint64_t drops) noexcept {
    if (drops == r.drops_seen) {
        return;
    }
    r.drops_seen = drops;
    if (r.retrace.isAway()) {
        r.isPathLeft = true;
    } else {
        r.retrace.clear();
    }
}

/// How much of the limits the step to `pose` uses.
traj::Retrace::Use use_of(Retracing &r, const geom::Pose &pose, const JointUse &joints,
                          const FoldedLimits &folded, double period_s) noexcept {
    traj::Retrace::Use use;
    if (r.retrace.isEmpty()) {
        r.last_pose = pose;
        r.last_step = {};
        return use;
    }
    const double per_s = 1.0 / period_s;
    const geom::Pose step = pose - r.last_pose;
    const geom::Pose bend = step - r.last_step;
    r.last_pose = pose;
    r.last_step = step;
    const traj::Limits &limits = folded.path;
    const auto add = [&](double v, double a, double most_a, double most_j) {
        if (v == 0 && a == 0) {
            return;
        }
        use.v_over_a = std::max(use.v_over_a, std::abs(v) * per_s / most_a);
        if (limits.isJerkLimited) {
            use.v_over_j = std::max(use.v_over_j, std::abs(v) * per_s / most_j);
            use.a_over_j = std::max(use.a_over_j, std::abs(a) * per_s * per_s / most_j);
        }
    };
    for (int i = 0; i < geom::AXIS_COUNT; ++i) {
        add(step[i], bend[i], limits.acceleration[at(i)], limits.jerk[at(i)]);
    }
    add(geom::norm_xyz(step), geom::norm_xyz(bend), limits.acceleration[traj::XYZ_NORM],
        limits.jerk[traj::XYZ_NORM]);
    for (int j = 0; j < joints.count; ++j) {
        add(joints.step[at(j)], joints.bend[at(j)], folded.joints.acceleration[at(j)],
            folded.joints.jerk[at(j)]);
    }
    return use;
}

}  // namespace

bool step(Retracing &r, geom::Pose &pose, const RetraceInputs &in) noexcept {
    follow_drops(r, in.drops);
    traj::Retrace &retrace = r.retrace;
    const bool isFirst = !retrace.isAway() && in.isReverseWanted && !in.isStandingWanted && !in.isStopping;
    if (!retrace.isAway() && !(isFirst && in.isPathAtRest && retrace.isReady())) {
        return false;
    }
    const bool isStill = in.isStandingWanted || r.isPathLeft || in.isStopping;
    const int direction = isStill ? 0 : in.isReverseWanted ? -1 : 1;
    pose = retrace.step(in.period_s, direction, in.rate);
    const bool isNewStart = r.isPathLeft && !retrace.isMoving();
    if (isNewStart) {
        r.isPathLeft = false;
        retrace.clear();
    }
    return isNewStart;
}

void record(Retracing &r, const geom::Pose &pose, const JointUse &joints, const FoldedLimits &limits,
            double period_s) noexcept {
    r.retrace.record(pose, use_of(r, pose, joints, limits, period_s));
}

}  // namespace mw::motion

// SPDX-License-Identifier: GPL-2.0-or-later
#include "motion/servo/coord/retracing.hh"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace mw::motion {

namespace {

std::size_t at(int i) noexcept {
    return static_cast<std::size_t>(i);
}

double square_xyz(const std::array<double, Changes::PADDED> &p) noexcept {
    return p[geometry::AXIS_X] * p[geometry::AXIS_X] + p[geometry::AXIS_Y] * p[geometry::AXIS_Y] +
           p[geometry::AXIS_Z] * p[geometry::AXIS_Z];
}

/// A path that is dropped during reverse run ends at the current position.
void follow_drops(Retracing &r, std::uint64_t drops) noexcept {
    if (drops == r.drops_seen) [[likely]] {
        return;
    }
    r.drops_seen = drops;
    if (r.retrace.isAway()) {
        r.isPathLeft = true;
    } else {
        r.retrace.clear();
    }
}

/// Use of the limits by the largest changes.
trajectory::Retrace::Use use_of(const Changes &changes, const RetraceLimits &in) noexcept {
    trajectory::Retrace::Use use;
    const double per_s = 1.0 / in.period_s;
    const trajectory::Limits &limits = in.folded.path;
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
    for (int i = 0; i < geometry::AXIS_COUNT; ++i) {
        add(changes.step[at(i)], changes.bend[at(i)], limits.acceleration[at(i)], limits.jerk[at(i)]);
    }
    add(std::sqrt(changes.step_xyz2), std::sqrt(changes.bend_xyz2), limits.acceleration[trajectory::XYZ_NORM],
        limits.jerk[trajectory::XYZ_NORM]);
    for (int j = 0; j < in.joints; ++j) {
        add(changes.joint_step[at(j)], changes.joint_bend[at(j)], in.folded.path_joints.acceleration[at(j)],
            in.folded.path_joints.jerk[at(j)]);
    }
    return use;
}

/// Compares the changes recorded since the last call with the limits; this takes longer than recording.
void weigh(Retracing &r, const RetraceLimits &limits) noexcept {
    r.retrace.include(use_of(r.changes, limits));
    r.changes = {};
}

/// True where reverse run is so slow that an immediate stop is within all limits: the path stopped there, and
/// reverse run has the recorded speeds.
bool mayStandAtOnce(const Changes &last, const RetraceLimits &limits) noexcept {
    // The stop of a step requires the jerk of twice the step and of its second difference.
    constexpr double STEP_SHARE = 0.25, BEND_SHARE = 0.5;
    const double t = limits.period_s;
    const trajectory::Retrace::Use use = use_of(last, limits);
    return use.v_over_a <= STEP_SHARE * t && use.v_over_j <= STEP_SHARE * t * t &&
           use.a_over_j <= BEND_SHARE * t;
}

void follow_way(Retracing &r, const geometry::Pose &pose) noexcept {
    Changes &last = r.last;
    for (int i = 0; i < geometry::AXIS_COUNT; ++i) {
        const double step = pose[i] - r.way_pose[i];
        last.bend[at(i)] = step - last.step[at(i)];
        last.step[at(i)] = step;
    }
    last.step_xyz2 = square_xyz(last.step);
    last.bend_xyz2 = square_xyz(last.bend);
    r.way_pose = pose;
}

}  // namespace

bool step(Retracing &r, geometry::Pose &pose, const RetraceInputs &in, const RetraceLimits &limits) noexcept {
    follow_drops(r, in.drops);
    trajectory::Retrace &retrace = r.retrace;
    const bool isFirst = !retrace.isAway() && in.isReverseWanted && !in.isStandingWanted && !in.isStopping;
    if (!retrace.isAway() && !(isFirst && in.isPathHeld && retrace.isReady())) [[likely]] {
        return false;
    }
    if (isFirst) {
        weigh(r, limits);
        r.way_pose = pose;
        r.last = {};
        r.wasStill = false;
    }
    const bool isStill = in.isStandingWanted || r.isPathLeft || in.isStopping;
    // With ordinary braking it would move at the recorded speed of the path, visibly after the stop.
    if (isStill && !r.wasStill && retrace.isMoving() && mayStandAtOnce(r.last, limits)) {
        retrace.stand();
    }
    r.wasStill = isStill;
    const int direction = isStill ? 0 : in.isReverseWanted ? -1 : 1;
    pose = retrace.step(limits.period_s, direction, in.rate);
    follow_way(r, pose);
    const bool isNewStart = r.isPathLeft && !retrace.isMoving();
    if (isNewStart) {
        r.isPathLeft = false;
        retrace.clear();
    }
    return isNewStart;
}

void record(Retracing &r, const geometry::Pose &pose, const RetraceLimits &limits) noexcept {
    alignas(16) std::array<double, Changes::PADDED> place;  // NOLINT: every element is set
    std::memcpy(place.data(), pose.c.data(), sizeof pose.c);
    place[geometry::AXIS_COUNT] = 0;
    Changes &changes = r.changes;
    if (r.retrace.isEmpty()) [[unlikely]] {
        changes = {};
        r.last_step = {};
    } else {
        alignas(16) std::array<double, Changes::PADDED> step, bend;  // NOLINT: every element is set
#pragma GCC unroll 5
        for (std::size_t i = 0; i < Changes::PADDED; ++i) {
            step[i] = place[i] - r.last_place[i];
            bend[i] = step[i] - r.last_step[i];
            r.last_step[i] = step[i];
            changes.step[i] = std::max(changes.step[i], std::abs(step[i]));
            changes.bend[i] = std::max(changes.bend[i], std::abs(bend[i]));
        }
        changes.step_xyz2 = std::max(changes.step_xyz2, square_xyz(step));
        changes.bend_xyz2 = std::max(changes.bend_xyz2, square_xyz(bend));
    }
    r.last_place = place;
    if (r.retrace.record(pose)) [[unlikely]] {
        weigh(r, limits);
    }
}

void record_joint(Retracing &r, int j, double step, double bend) noexcept {
    r.changes.joint_step[at(j)] = std::max(r.changes.joint_step[at(j)], std::abs(step));
    r.changes.joint_bend[at(j)] = std::max(r.changes.joint_bend[at(j)], std::abs(bend));
}

void follow_joint(Retracing &r, int j, double step, double bend) noexcept {
    r.last.joint_step[at(j)] = step;
    r.last.joint_bend[at(j)] = bend;
}

}  // namespace mw::motion

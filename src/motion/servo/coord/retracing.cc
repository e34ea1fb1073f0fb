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

/// Fraction of the limits that the largest changes use.
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
        add(changes.step[at(i)], changes.step_change[at(i)], limits.acceleration[at(i)], limits.jerk[at(i)]);
    }
    add(std::sqrt(changes.step_xyz2), std::sqrt(changes.step_change_xyz2),
        limits.acceleration[trajectory::XYZ_NORM], limits.jerk[trajectory::XYZ_NORM]);
    for (int j = 0; j < in.joints; ++j) {
        add(changes.joint_step[at(j)], changes.joint_step_change[at(j)],
            in.folded.path_joints.acceleration[at(j)], in.folded.path_joints.jerk[at(j)]);
    }
    return use;
}

/// True if reverse run is so slow that an immediate stop is within all limits. The path had stopped there,
/// and reverse run has the recorded speeds.
bool mayStopAtOnce(const Changes &last, const RetraceLimits &limits) noexcept {
    // Stopping from a step requires a jerk of twice the step and of its second difference.
    constexpr double STEP_SHARE = 0.25, CHANGE_SHARE = 0.5;
    const double t = limits.period_s;
    const trajectory::Retrace::Use use = use_of(last, limits);
    return use.v_over_a <= STEP_SHARE * t && use.v_over_j <= STEP_SHARE * t * t &&
           use.a_over_j <= CHANGE_SHARE * t;
}

}  // namespace

/// A path that is dropped during reverse run ends at the current position.
void Retracing::follow_drops(std::uint64_t drops) noexcept {
    if (drops == drops_seen_) [[likely]] {
        return;
    }
    drops_seen_ = drops;
    if (retrace_.isAway()) {
        path_left_ = true;
    } else {
        retrace_.clear();
    }
}

/// Compares the changes recorded since the last call with the limits. This takes longer than recording.
void Retracing::include_changes(const RetraceLimits &limits) noexcept {
    retrace_.include(use_of(changes_, limits));
    changes_ = {};
}

void Retracing::follow_pose(const geometry::Pose &pose) noexcept {
    for (int i = 0; i < geometry::AXIS_COUNT; ++i) {
        const double step = pose[i] - pose_[i];
        last_.step_change[at(i)] = step - last_.step[at(i)];
        last_.step[at(i)] = step;
    }
    last_.step_xyz2 = square_xyz(last_.step);
    last_.step_change_xyz2 = square_xyz(last_.step_change);
    pose_ = pose;
}

bool Retracing::step(geometry::Pose &pose, const RetraceInputs &in, const RetraceLimits &limits) noexcept {
    follow_drops(in.drops);
    const bool isFirst = !retrace_.isAway() && in.isReverseWanted && !in.isHoldWanted && !in.isStopping;
    if (!retrace_.isAway() && !(isFirst && in.isPathHeld && retrace_.isReady())) [[likely]] {
        return false;
    }
    if (isFirst) {
        include_changes(limits);
        pose_ = pose;
        last_ = {};
        stopping_ = false;
    }
    const bool isStill = in.isHoldWanted || path_left_ || in.isStopping;
    // With ordinary braking it would visibly move after the stop, at the recorded speed of the path.
    if (isStill && !stopping_ && retrace_.isMoving() && mayStopAtOnce(last_, limits)) {
        retrace_.stand();
    }
    stopping_ = isStill;
    const int direction = isStill ? 0 : in.isReverseWanted ? -1 : 1;
    pose = retrace_.step(limits.period_s, direction, in.rate);
    follow_pose(pose);
    const bool isNewStart = path_left_ && !retrace_.isMoving();
    if (isNewStart) {
        path_left_ = false;
        retrace_.clear();
    }
    return isNewStart;
}

void Retracing::record(const geometry::Pose &pose, const RetraceLimits &limits) noexcept {
    alignas(16) std::array<double, Changes::PADDED> position;  // NOLINT: every element is set
    std::memcpy(position.data(), pose.c.data(), sizeof pose.c);
    position[geometry::AXIS_COUNT] = 0;
    if (retrace_.isEmpty()) [[unlikely]] {
        changes_ = {};
        last_step_ = {};
    } else {
        alignas(16) std::array<double, Changes::PADDED> step, step_change;  // NOLINT: every element is set
#pragma GCC unroll 5
        for (std::size_t i = 0; i < Changes::PADDED; ++i) {
            step[i] = position[i] - last_position_[i];
            step_change[i] = step[i] - last_step_[i];
            last_step_[i] = step[i];
            changes_.step[i] = std::max(changes_.step[i], std::abs(step[i]));
            changes_.step_change[i] = std::max(changes_.step_change[i], std::abs(step_change[i]));
        }
        changes_.step_xyz2 = std::max(changes_.step_xyz2, square_xyz(step));
        changes_.step_change_xyz2 = std::max(changes_.step_change_xyz2, square_xyz(step_change));
    }
    last_position_ = position;
    if (retrace_.record(pose)) [[unlikely]] {
        include_changes(limits);
    }
}

void Retracing::record_joint(int j, double step, double step_change) noexcept {
    changes_.joint_step[at(j)] = std::max(changes_.joint_step[at(j)], std::abs(step));
    changes_.joint_step_change[at(j)] = std::max(changes_.joint_step_change[at(j)], std::abs(step_change));
}

void Retracing::follow_joint(int j, double step, double step_change) noexcept {
    last_.joint_step[at(j)] = step;
    last_.joint_step_change[at(j)] = step_change;
}

}  // namespace mw::motion

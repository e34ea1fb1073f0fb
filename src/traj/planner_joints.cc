// SPDX-License-Identifier: GPL-2.0-or-later
// Limits of joints that are not axes: their derivatives along a piece by differences of the inverse
// kinematics.
#include <algorithm>
#include <cmath>

#include "traj/planner.hh"
#include "traj/tuning.hh"

namespace mw::traj {

void Planner::set_joints(const JointMap *map, const JointLimits &limits) noexcept {
    joint_map_ = map;
    joint_limits_ = limits;
}

/// The limits of the piece, lowered to what its joints can do.
SpeedLimit Planner::limit_with_joints(const Piece &piece, const SpeedLimit &limit) const noexcept {
    const int count = joint_limits_.count;
    LimitRow rows[MAX_JOINTS];
    const double h = std::min(JointTuning::STEP, 0.25 * piece.length);
    for (int n = 0; n < JointTuning::SAMPLES; ++n) {
        const double x = std::clamp(piece.length * n / (JointTuning::SAMPLES - 1), h, piece.length - h);
        double before[MAX_JOINTS] = {};
        double at[MAX_JOINTS] = {};
        double after[MAX_JOINTS] = {};
        const bool isFound = joint_map_->joints_at(position_at(store_, piece, x - h), before) &&
                             joint_map_->joints_at(position_at(store_, piece, x), at) &&
                             joint_map_->joints_at(position_at(store_, piece, x + h), after);
        for (int j = 0; j < count && isFound; ++j) {
            LimitRow &row = rows[j];
            const double q1 = std::abs(after[j] - before[j]) / (2.0 * h);
            const double q2 = std::abs(after[j] - 2.0 * at[j] + before[j]) / (h * h);
            const double noise = 4.0 * 0x1p-52 * std::abs(at[j]) / (h * h);
            row.q1 = std::max(row.q1, q1);
            row.q2 = std::max(row.q2, q2 > JointTuning::JITTER + 4.0 * noise ? q2 : 0.0);
        }
    }
    int used = 0;
    for (int j = 0; j < count; ++j) {
        LimitRow row = rows[j];
        if (row.q1 <= 0 && row.q2 <= 0) {
            continue;
        }
        const auto n = static_cast<std::size_t>(j);
        // The first derivative grows by the second from one sample to the next.
        row.q1 = row.q1 * JointTuning::SAMPLING_MARGIN +
                 row.q2 * piece.length / (2.0 * (JointTuning::SAMPLES - 1));
        row.q2 *= JointTuning::SAMPLING_MARGIN * JointTuning::SAMPLING_MARGIN;
        row.velocity = joint_limits_.velocity[n];
        row.acceleration = joint_limits_.acceleration[n];
        if (isFiltered()) {
            row.acceleration = std::min(row.acceleration, joint_limits_.jerk[n] * filter_s());
        }
        rows[used++] = row;
    }
    const SpeedLimit joints = limit_of_rows(rows, used, limit.v);
    return {joints.v, AccelBound::least(limit.a, joints.a, joints.v)};
}

/// The joints of what is commanded, at the newest sample of the trial, are within their limits.
bool Planner::areJointsSound() noexcept {
    const Pose mean = trial_origin_ + trial_sum_ * (1.0 / static_cast<double>(filter_));
    std::array<std::array<double, MAX_JOINTS>, 4> &q = trial_joints_;
    const std::uint64_t n = trial_tick_;
    std::array<double, MAX_JOINTS> &now = q[n % 4];
    now = {};
    if (!joint_map_->joints_at(mean, now.data())) {
        return false;
    }
    joint_samples_ = n == joint_tick_ + 1 ? joint_samples_ + 1 : 0;
    joint_tick_ = n;
    const double t = settings_.period_s;
    for (std::size_t j = 0; j < static_cast<std::size_t>(joint_limits_.count); ++j) {
        const double one = q[(n - 1) % 4][j];
        const double two = q[(n - 2) % 4][j];
        const double three = q[(n - 3) % 4][j];
        const double rounding = 0x1p-52 * std::abs(now[j]);
        const double v = std::abs(now[j] - one);
        const double a = std::abs(now[j] - 2.0 * one + two);
        const double jerk = std::abs(now[j] - 3.0 * (one - two) - three);
        const bool isOver =
            (joint_samples_ >= 1 &&
             v > joint_limits_.velocity[j] * t * TrialTuning::SLACK + 2.0 * rounding) ||
            (joint_samples_ >= 2 &&
             a > joint_limits_.acceleration[j] * t * t * TrialTuning::SLACK + 4.0 * rounding) ||
            (joint_samples_ >= 3 && isFiltered() &&
             jerk > joint_limits_.jerk[j] * t * t * t * TrialTuning::SLACK + 8.0 * rounding);
        if (isOver) {
            return false;
        }
    }
    return true;
}

}  // namespace mw::traj

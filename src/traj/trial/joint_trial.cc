// SPDX-License-Identifier: GPL-2.0-or-later
#include "traj/trial/joint_trial.hh"

#include <algorithm>
#include <cmath>

#include "traj/tuning.hh"

namespace mw::traj {

bool JointTrial::isSound(const Conditions &conditions, const Pose &pose, std::uint64_t tick) noexcept {
    const JointLimits &limits = conditions.workspace.joints;
    std::array<double, MAX_JOINTS> &now = joints_[tick % 4];
    now = {};
    excess_ = 0;
    if (!conditions.workspace.map->joints_at(pose, now.data())) {
        return false;
    }
    samples_ = tick == tick_ + 1 ? samples_ + 1 : 0;
    tick_ = tick;
    const double t = conditions.limits.period_s();
    constexpr double SLACK = TrialTuning::SLACK;
    bool isSound = true;
    const auto keep = [&](double used, double allowed, double excess) {
        isSound = isSound && !(used > allowed);
        excess_ = used > allowed ? std::max(excess_, excess) : excess_;
    };
    for (std::size_t j = 0; j < static_cast<std::size_t>(limits.count) && samples_ >= 1; ++j) {
        const double one = joints_[(tick - 1) % 4][j];
        const double two = joints_[(tick - 2) % 4][j];
        const double three = joints_[(tick - 3) % 4][j];
        const double rounding = 0x1p-52 * std::abs(now[j]);
        const double v = std::abs(now[j] - one);
        const double v_most = limits.velocity[j] * t * SLACK + 2.0 * rounding;
        keep(v, v_most, v * v / (v_most * v_most));
        if (samples_ >= 2) {
            const double a = std::abs(now[j] - 2.0 * one + two);
            const double a_most = limits.acceleration[j] * t * t * SLACK + 4.0 * rounding;
            keep(a, a_most, a / a_most);
        }
        if (samples_ >= 3 && conditions.limits.isFiltered()) {
            const double jerk = std::abs(now[j] - 3.0 * (one - two) - three);
            const double jerk_most = limits.jerk[j] * t * t * t * SLACK + 8.0 * rounding;
            keep(jerk, jerk_most, jerk / jerk_most);
        }
    }
    return isSound;
}

}  // namespace mw::traj

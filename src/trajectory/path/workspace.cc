// SPDX-License-Identifier: GPL-2.0-or-later
#include "trajectory/path/workspace.hh"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

namespace mw::trajectory {

bool Workspace::holds(const Pose &pose) const noexcept {
    bool isInside = true;
    for (int i = 0; i < geometry::AXIS_COUNT; ++i) {
        isInside = isInside && pose[i] >= low[i] && pose[i] <= high[i];
    }
    double at[MAX_JOINTS] = {};
    const bool isAsked = isInside && isMapped() && joint_room.joints != 0;
    isInside = isInside && (!isAsked || map->joints_at(pose, at));
    for (std::uint32_t left = isAsked ? joint_room.joints : 0; left != 0; left &= left - 1) {
        const auto j = static_cast<std::size_t>(std::countr_zero(left));
        isInside = isInside && at[j] >= joint_room.low[j] && at[j] <= joint_room.high[j];
    }
    return isInside;
}

/// Raises `reach` to the maximum change of each joint when each coordinate of `pose` changes by up to the
/// tolerance. False if the kinematics has no solution.
bool Workspace::take_reach(const Pose &pose, double tolerance, PerJoint &reach) const noexcept {
    // Bound of the change within the tolerance, relative to the change between its ends.
    constexpr double MARGIN = 2;
    PerJoint at{}, sum{};
    bool exists = map->joints_at(pose, at.data());
    for (int i = 0; i < geometry::AXIS_COUNT && exists; ++i) {
        for (const double side : {-tolerance, tolerance}) {
            Pose moved = pose;
            moved[i] += side;
            PerJoint there{};
            exists = exists && map->joints_at(moved, there.data());
            for (std::size_t j = 0; j < static_cast<std::size_t>(joints.count) && exists; ++j) {
                sum[j] += 0.5 * MARGIN * std::abs(there[j] - at[j]);
            }
        }
    }
    for (std::size_t j = 0; j < reach.size() && exists; ++j) {
        reach[j] = std::max(reach[j], sum[j]);
    }
    return exists;
}

/// Minimum distance of the joints to their soft limits along the move, as a fraction of their `reach`; 0
/// to 1.
double Workspace::least_share(const Primitive &move, int samples, const PerJoint &reach) const noexcept {
    double share = 1;
    PerJoint before{};
    for (int n = 0; n < samples; ++n) {
        PerJoint at = before;
        if (!map->joints_at(position_at(move, move.length * n / (samples - 1)), at.data())) {
            return 0;
        }
        for (std::size_t j = 0; j < static_cast<std::size_t>(joints.count); ++j) {
            // Between two samples, a joint exceeds them by at most its change.
            const double step = n > 0 ? std::abs(at[j] - before[j]) : 0.0;
            const double left = std::min(at[j] - low_of(j), high_of(j) - at[j]) - step;
            share = !isLinear(j) && left < reach[j] ? std::min(share, left / reach[j]) : share;
        }
        before = at;
    }
    return std::max(share, 0.0);
}

double Workspace::tolerance_within(const Primitive &move, double tolerance) const noexcept {
    // FEW samples if the joints are far from their limits, otherwise as many as the check of the move takes.
    constexpr int FEW = 9, MANY = 65;
    constexpr double PER_RAD = 1.5, MOST = 2000;
    const bool is_linear = (~linear.joints & ((1U << joints.count) - 1U)) == 0;
    if (!isMapped() || is_linear || tolerance <= 0) {
        return tolerance;
    }
    PerJoint reach{};
    for (const double part : {0.0, 0.5, 1.0}) {
        if (!take_reach(position_at(move, part * move.length), tolerance, reach)) {
            return 0;
        }
    }
    // With too few samples on an arc of many revolutions, the steps are large and the share is too small.
    const int turns = static_cast<int>(std::min(std::abs(move.omega) * move.length * PER_RAD, MOST));
    const double share = least_share(move, std::max(FEW, turns), reach);
    return tolerance * (share < 1 ? least_share(move, std::max(MANY, 8 * turns), reach) : share);
}

}  // namespace mw::trajectory

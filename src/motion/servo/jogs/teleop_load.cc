// SPDX-License-Identifier: GPL-2.0-or-later
#include "motion/servo/jogs/teleop_load.hh"

#include <algorithm>
#include <cmath>

namespace mw::motion {

namespace {

/// Distances for derivatives and third derivatives [machine units, degrees].
constexpr double STEP = 1e-3, SMOOTH_STEP = 0.1;
/// Between the sampled positions derivatives may be larger by this factor; where a joint follows the moving
/// axes along straight lines, by rounding.
constexpr double MARGIN = 1.05, STRAIGHT_MARGIN = 1.0 + 1e-6;

std::size_t at(int i) noexcept {
    return static_cast<std::size_t>(i);
}

/// Third differences along one axis; the joint positions one step `after` and `before` are known.
bool add_third(const TeleopMachine &m, const geometry::Pose &pose, int i, const JointsAt &after,
               const JointsAt &before, TeleopLoad &load) noexcept {
    const int axis = load.axes[at(i)];
    JointsAt far_after{};
    JointsAt far_before{};
    geometry::Pose p = pose;
    p[axis] += 2.0 * SMOOTH_STEP;
    bool isFound = find_joints(m, p, far_after);
    p[axis] -= 4.0 * SMOOTH_STEP;
    isFound = isFound && find_joints(m, p, far_before);
    constexpr double CUBE = SMOOTH_STEP * SMOOTH_STEP * SMOOTH_STEP;
    for (std::size_t j = 0; j < at(m.num_joints) && isFound; ++j) {
        const double third = 0.5 * (far_after[j] - far_before[j]) - (after[j] - before[j]);
        load.q3[at(i)][j] = std::max(load.q3[at(i)][j], MARGIN * std::abs(third) / CUBE);
    }
    return isFound;
}

/// Change of second derivatives from the first sample to one that is displaced along one axis.
void add_turn(const TeleopMachine &m, const TeleopLoad &first, const double *q2, int i, int k, Displaced from,
              TeleopLoad &load) noexcept {
    const bool isAlone = i == from.index && k == from.index;
    for (int j = 0; j < m.num_joints && !isAlone; ++j) {
        const double change = std::abs(q2[j] - first.q2_here[at(i)][at(k)][at(j)]) / std::abs(from.way);
        const double both = i == k ? 1.0 : 2.0;
        load.turn[at(from.index)][at(j)] += both * MARGIN * change * load.speed[at(i)] * load.speed[at(k)];
    }
}

}  // namespace

bool find_joints(const TeleopMachine &m, const geometry::Pose &pose, JointsAt &joints) noexcept {
    std::copy_n(m.joint_positions.begin(), m.num_joints, joints.begin());
    return m.kinematics.side(pose) == m.side &&
           m.kinematics.inverse(pose, joints.data()) == kinematics::Status::OK;
}

bool add_load(const TeleopMachine &m, const geometry::Pose &pose, TeleopLoad &load, Displaced from) noexcept {
    const double step = load.isSmooth ? SMOOTH_STEP : STEP;
    const auto joints_at = [&](const geometry::Pose &p, JointsAt &q) { return find_joints(m, p, q); };
    JointsAt here{};
    std::array<JointsAt, MAX_AXES> after{};
    JointsAt other{};
    JointsAt signed_q2{};
    std::array<JointsAt, MAX_AXES> q1{};
    std::array<JointsAt, MAX_AXES> bend{};  // greatest second derivative with any axis that moves
    const auto keep = [&](int i, int k) {
        if (load.isSmooth && !load.isBegun) {
            load.q2_here[at(i)][at(k)] = signed_q2;
        } else if (load.isSmooth && from.index >= 0) {
            add_turn(m, load, signed_q2.data(), i, k, from, load);
        }
    };
    bool isFound = joints_at(pose, here);
    for (int i = 0; i < load.count && isFound; ++i) {
        const int axis = load.axes[at(i)];
        geometry::Pose p = pose;
        p[axis] += step;
        isFound = joints_at(p, after[at(i)]);
        p[axis] -= 2.0 * step;
        isFound = isFound && joints_at(p, other);
        for (std::size_t j = 0; j < at(m.num_joints) && isFound; ++j) {
            q1[at(i)][j] = std::abs(after[at(i)][j] - other[j]) / (2.0 * step);
            signed_q2[j] = (after[at(i)][j] - 2.0 * here[j] + other[j]) / (step * step);
            bend[at(i)][j] = std::max(bend[at(i)][j], std::abs(signed_q2[j]));
            load.q2[at(i)][at(i)][j] = std::max(load.q2[at(i)][at(i)][j], MARGIN * std::abs(signed_q2[j]));
        }
        const bool isThird = load.isSmooth && from.index < 0;
        isFound = isFound && (!isThird || add_third(m, pose, i, after[at(i)], other, load));
        keep(i, i);
        for (int k = 0; k < i && isFound; ++k) {
            p = pose;
            p[axis] += step;
            p[load.axes[at(k)]] += step;
            isFound = joints_at(p, other);
            for (std::size_t j = 0; j < at(m.num_joints) && isFound; ++j) {
                const double both = other[j] - after[at(i)][j] - after[at(k)][j] + here[j];
                signed_q2[j] = both / (step * step);
                bend[at(i)][j] = std::max(bend[at(i)][j], std::abs(signed_q2[j]));
                bend[at(k)][j] = std::max(bend[at(k)][j], std::abs(signed_q2[j]));
                double &q2 = load.q2[at(i)][at(k)][j];
                q2 = std::max(q2, MARGIN * std::abs(both) / (step * step));
                load.q2[at(k)][at(i)][j] = q2;
            }
            keep(i, k);
        }
    }
    load.isBegun = true;
    for (int i = 0; i < load.count && isFound; ++i) {
        for (std::size_t j = 0; j < at(m.num_joints); ++j) {
            const bool isStraight = load.isSmooth && bend[at(i)][j] <= LEAST_CURVE;
            const double margin = isStraight ? STRAIGHT_MARGIN : MARGIN;
            load.q1[at(i)][j] = std::max(load.q1[at(i)][j], margin * q1[at(i)][j]);
        }
    }
    return isFound;
}

void add_sent(const TeleopMachine &m, const geometry::Pose &here, int i, double target,
              TeleopLoad &load) noexcept {
    constexpr int MOST_PLACES = 8;
    const int axis = load.axes[at(i)];
    double most = std::abs(target - here[axis]);
    for (int j = 0; j < m.num_joints; ++j) {
        const double range = m.joints.high[at(j)] - m.joints.low[at(j)];
        const double q1 = load.q1[at(i)][at(j)];
        most = q1 > 0 ? std::min(most, range / q1) : most;
    }
    double way = target < here[axis] ? -most : most;
    for (int n = 0; n < MOST_PLACES; ++n, way *= 0.5) {
        JointsAt before{};
        JointsAt after{};
        geometry::Pose p = here;
        p[axis] += way - SMOOTH_STEP;
        bool isFound = find_joints(m, p, before);
        p[axis] += 2.0 * SMOOTH_STEP;
        isFound = isFound && find_joints(m, p, after);
        if (isFound) {
            for (std::size_t j = 0; j < at(m.num_joints); ++j) {
                load.q1_sent[at(i)][j] = std::abs(after[j] - before[j]) / (2.0 * SMOOTH_STEP);
            }
            return;
        }
    }
}

AxisValues shared_speeds(const TeleopMachine &m, const TeleopLoad &load, const Jogs &jogs,
                         double n) noexcept {
    AxisValues v{};
    for (int i = 0; i < load.count; ++i) {
        const Jog &axis = jogs.axis[at(load.axes[at(i)])];
        const double most = m.limits.axis_jog[at(load.axes[at(i)])].velocity;
        v[at(i)] = std::min(axis.wanted_velocity * m.scale, most);
        for (int j = 0; j < m.num_joints; ++j) {
            const double q1 = load.q1[at(i)][at(j)];
            const double q2 = load.q2[at(i)][at(i)][at(j)];
            const double curve = CURVE_SHARE * m.joints.acceleration[at(j)] / (n * n);
            if (q1 > 0) {
                v[at(i)] = std::min(v[at(i)], m.joints.velocity[at(j)] / (n * q1));
            }
            if (q2 > LEAST_CURVE) {
                v[at(i)] = std::min(v[at(i)], std::sqrt(curve / q2));
            }
        }
    }
    for (int i = 0; i < load.count; ++i) {
        for (int k = 0; k < i; ++k) {
            for (int j = 0; j < m.num_joints; ++j) {
                const double curve = CURVE_SHARE * m.joints.acceleration[at(j)] / (n * n);
                const double used = load.q2[at(i)][at(k)][at(j)] * v[at(i)] * v[at(k)];
                const double factor = used > curve ? std::sqrt(curve / used) : 1.0;
                v[at(i)] *= factor;
                v[at(k)] *= factor;
            }
        }
    }
    return v;
}

double with_reserve(const TeleopLoad &load, const trajectory::AxisTrajectory &p,
                    double acceleration) noexcept {
    constexpr double PLANNED = 0.75;
    const trajectory::AxisMotion &leader = p.leader();
    const double way = p.target - leader.position;
    if (load.count < 2 || !(leader.velocity * way > 0)) {
        return acceleration;
    }
    bool isCurved = false;
    for (int i = 0; i < load.count && !isCurved; ++i) {
        for (int k = 0; k < load.count && !isCurved; ++k) {
            isCurved = std::ranges::any_of(load.q2[at(i)][at(k)], [](double x) { return x > LEAST_CURVE; });
        }
    }
    constexpr double ROUNDING = 1.0 + 1e-9;
    const double needed = ROUNDING * leader.velocity * leader.velocity / (2.0 * std::abs(way));
    return isCurved ? std::clamp(needed, PLANNED * acceleration, acceleration) : acceleration;
}

bool mustBrake(const trajectory::AxisTrajectory &p, double acceleration) noexcept {
    constexpr double NEARLY = 0.9;
    const trajectory::AxisMotion &leader = p.leader();
    const double v = leader.velocity;
    const double way = p.target - leader.position;
    return v * way > 0 && v * v >= NEARLY * 2.0 * acceleration * std::abs(way);
}

double kept(double had, double acceleration, double share, bool isBraking) noexcept {
    return isBraking && had <= share * acceleration ? std::max(acceleration, had) : acceleration;
}

bool canTake(const trajectory::AxisTrajectory &p, double acceleration, double period_s) noexcept {
    const trajectory::AxisMotion &leader = p.leader();
    const double v = leader.velocity;
    const double rest = trajectory::stop_position(leader.position + v * period_s, v, acceleration);
    return v == 0.0 || (v > 0 ? rest <= p.target : rest >= p.target);
}

}  // namespace mw::motion

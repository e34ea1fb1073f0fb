// SPDX-License-Identifier: GPL-2.0-or-later
#include "motion/servo/jogs/joint_load.hh"

#include <algorithm>
#include <cmath>
#include <limits>

namespace mw::motion {

namespace {

/// Step sizes for derivatives, and for third derivatives [machine units, degrees].
constexpr double STEP = 1e-3, JERK_STEP = 0.1;
/// Between the samples a derivative may be larger by this factor. For a joint that is linear in the axes the
/// factor covers rounding only. The margin for allowed values is larger than that of the check, because the
/// next cycle samples other positions.
struct Margin {
    double curved, straight;
};
constexpr Margin ALLOWED{1.08, 1.0 + 2e-6}, CHECKED{1.05, 1.0 + 1e-6};
/// A second derivative below this is rounding.
constexpr double LEAST_CURVE = 1e-6;
/// Fractions of the acceleration and jerk of a joint that curvature may use at maximum speed. The jerk has
/// one fraction for speed combined with acceleration, and one for speed alone.
constexpr double CURVE_SHARE = 0.5, SWING_SHARE = 0.25, TURN_SHARE = 0.25;
constexpr double NONE = std::numeric_limits<double>::infinity();

std::size_t at(int i) noexcept {
    return static_cast<std::size_t>(i);
}

/// The terms of a joint's velocity, acceleration and jerk.
class JointTerms {
  public:
    JointTerms(const JointLoad &load, std::uint32_t members, int joint, const Margin &margin) noexcept
        : load_(load), members_(members), joint_(at(joint)), margin_(margin.straight) {
        for (int i = 0; i < load.count; ++i) {
            for (int k = 0; k <= i; ++k) {
                const bool isCurved = has(i) && has(k) && load.q2[at(i)][at(k)][joint_] > LEAST_CURVE;
                margin_ = isCurved ? margin.curved : margin_;
            }
        }
    }
    bool has(int i) const noexcept { return (members_ >> load_.axes[at(i)] & 1U) != 0; }
    double q1(int i) const noexcept { return has(i) ? margin_ * load_.q1[at(i)][joint_] : 0.0; }
    double q2(int i, int k) const noexcept {
        const double q = has(i) && has(k) ? load_.q2[at(i)][at(k)][joint_] : 0.0;
        return q > LEAST_CURVE ? margin_ * q : 0.0;
    }
    /// sum q_i x_i
    double straight(const AxisValues &x) const noexcept {
        double sum = 0;
        for (int i = 0; i < load_.count; ++i) {
            sum += q1(i) * x[at(i)];
        }
        return sum;
    }
    /// sum q_ik x_i y_k
    double curve(const AxisValues &x, const AxisValues &y) const noexcept {
        double sum = 0;
        for (int i = 0; i < load_.count; ++i) {
            for (int k = 0; k < load_.count; ++k) {
                sum += q2(i, k) * x[at(i)] * y[at(k)];
            }
        }
        return sum;
    }
    /// q_ikl v_i v_k v_l
    double turn(const AxisValues &v) const noexcept {
        double alone = 0;
        double square = 0;
        for (int i = 0; i < load_.count; ++i) {
            const double x = has(i) ? v[at(i)] : 0.0;
            alone += load_.q3[at(i)][joint_] * x * x * x;
            square += x * x;
        }
        return margin_ * std::max(alone, load_.q3_together[joint_] * square * std::sqrt(square));
    }

  private:
    const JointLoad &load_;
    std::uint32_t members_;
    std::size_t joint_;
    double margin_;
};

double jerk_of(const TeleopMachine &m, const JointLoad &load, int j) noexcept {
    const double most = m.joints.jerk[at(j)];
    return load.hasJerk && most < trajectory::UNLIMITED ? most : NONE;
}

/// Reduces the values of the axes that move the joint, by the factor that reduces `used` to `most`.
template <class Uses>
void reduce(AxisValues &values, int count, double factor, Uses uses) noexcept {
    for (int i = 0; i < count && factor < 1.0; ++i) {
        values[at(i)] *= uses(i) ? factor : 1.0;
    }
}

double factor_to(double most, double used) noexcept {
    return used > most ? most / used : 1.0;
}

/// Limits the values to what each axis could have alone, because the requested values may have no limit.
void limit_alone(const TeleopMachine &m, const JointLoad &load, std::uint32_t members,
                 AxisDemand &out) noexcept {
    for (int j = 0; j < m.num_joints; ++j) {
        const JointTerms terms(load, members, j, ALLOWED);
        const double jerk = jerk_of(m, load, j);
        for (int i = 0; i < load.count; ++i) {
            const double q1 = terms.q1(i);
            if (!(q1 > 0)) {
                continue;
            }
            double &most = out.jerk[at(i)];
            out.velocity[at(i)] = std::min(out.velocity[at(i)], m.joints.velocity[at(j)] / q1);
            out.acceleration[at(i)] = std::min(out.acceleration[at(i)], m.joints.acceleration[at(j)] / q1);
            most = jerk < NONE ? (most > 0 ? std::min(most, jerk / q1) : jerk / q1) : most;
        }
    }
}

/// Speeds that leave part of the limits for curvature.
void limit_speeds(const TeleopMachine &m, const JointLoad &load, std::uint32_t members,
                  AxisDemand &out) noexcept {
    for (int j = 0; j < m.num_joints; ++j) {
        const JointTerms terms(load, members, j, ALLOWED);
        const auto moves = [&](int i) { return terms.q1(i) > 0; };
        const auto curves = [&](int i) {
            double sum = load.q3[at(i)][at(j)] + load.q3_together[at(j)];
            for (int k = 0; k < load.count; ++k) {
                sum += terms.q2(i, k);
            }
            return sum > 0;
        };
        AxisValues &v = out.velocity;
        reduce(v, load.count, factor_to(m.joints.velocity[at(j)], terms.straight(v)), moves);
        const double curve = factor_to(CURVE_SHARE * m.joints.acceleration[at(j)], terms.curve(v, v));
        reduce(v, load.count, std::sqrt(curve), curves);
        const double turn = factor_to(TURN_SHARE * jerk_of(m, load, j), terms.turn(v));
        reduce(v, load.count, std::cbrt(turn), curves);
    }
}

void limit_accelerations(const TeleopMachine &m, const JointLoad &load, std::uint32_t members,
                         AxisDemand &out) noexcept {
    for (int j = 0; j < m.num_joints; ++j) {
        const JointTerms terms(load, members, j, ALLOWED);
        const double left = m.joints.acceleration[at(j)] - terms.curve(out.velocity, out.velocity);
        reduce(out.acceleration, load.count, factor_to(left, terms.straight(out.acceleration)),
               [&](int i) { return terms.q1(i) > 0; });
        const double swing = 3 * terms.curve(out.velocity, out.acceleration);
        reduce(out.velocity, load.count, factor_to(SWING_SHARE * jerk_of(m, load, j), swing), [&](int i) {
            double sum = 0;
            for (int k = 0; k < load.count; ++k) {
                sum += terms.q2(i, k);
            }
            return sum > 0;
        });
    }
}

void limit_jerks(const TeleopMachine &m, const JointLoad &load, std::uint32_t members,
                 AxisDemand &out) noexcept {
    for (int j = 0; j < m.num_joints; ++j) {
        const JointTerms terms(load, members, j, ALLOWED);
        const double left =
            jerk_of(m, load, j) - 3 * terms.curve(out.velocity, out.acceleration) - terms.turn(out.velocity);
        reduce(out.jerk, load.count, factor_to(left, terms.straight(out.jerk)),
               [&](int i) { return terms.q1(i) > 0; });
    }
}

}  // namespace

bool find_joints(const TeleopMachine &m, const geometry::Pose &pose, JointsAt &joints) noexcept {
    std::copy_n(m.joint_positions.begin(), m.num_joints, joints.begin());
    return m.kinematics.side(pose) == m.side &&
           m.kinematics.inverse(pose, joints.data()) == kinematics::Status::OK;
}

namespace {

/// Finite differences of the joints around one pose.
class Differences {
  public:
    Differences(const TeleopMachine &m, const geometry::Pose &pose, JointLoad &load) noexcept
        : m_(m), pose_(pose), load_(load), step_(load.hasJerk ? JERK_STEP : STEP) {}

    bool add() noexcept {
        bool isFound = find_joints(m_, pose_, here_);
        for (int i = 0; i < load_.count && isFound; ++i) {
            isFound = add_axis(i);
            for (int k = 0; k < i && isFound; ++k) {
                isFound = add_pair(i, k);
            }
        }
        return isFound && (!load_.hasJerk || load_.count < 2 || add_together());
    }

  private:
    bool joints_at(const AxisValues &steps, JointsAt &q) const noexcept {
        geometry::Pose p = pose_;
        for (int i = 0; i < load_.count; ++i) {
            p[load_.axes[at(i)]] += steps[at(i)] * step_;
        }
        return find_joints(m_, p, q);
    }
    bool along(int i, double steps, JointsAt &q) const noexcept {
        AxisValues x{};
        x[at(i)] = steps;
        return joints_at(x, q);
    }
    static void keep(double &most, double value) noexcept { most = std::max(most, std::abs(value)); }

    /// Third differences with two steps to each side.
    void add_third(const JointsAt &far_after, const JointsAt &far_before, const JointsAt &after,
                   const JointsAt &before, JointsAt &most) const noexcept {
        for (std::size_t j = 0; j < at(m_.num_joints); ++j) {
            keep(most[j],
                 (0.5 * (far_after[j] - far_before[j]) - (after[j] - before[j])) / (step_ * step_ * step_));
        }
    }
    bool add_axis(int i) noexcept {
        JointsAt before{};
        if (!along(i, 1, after_[at(i)]) || !along(i, -1, before)) {
            return false;
        }
        const JointsAt &after = after_[at(i)];
        for (std::size_t j = 0; j < at(m_.num_joints); ++j) {
            // The larger of both sides, because the slope at the ends of the step is also used.
            keep(load_.q1[at(i)][j],
                 std::max(std::abs(after[j] - here_[j]), std::abs(here_[j] - before[j])) / step_);
            keep(load_.q2[at(i)][at(i)][j], (after[j] - 2.0 * here_[j] + before[j]) / (step_ * step_));
        }
        if (load_.hasJerk) {
            JointsAt far_after{};
            JointsAt far_before{};
            if (!along(i, 2, far_after) || !along(i, -2, far_before)) {
                return false;
            }
            add_third(far_after, far_before, after, before, load_.q3[at(i)]);
        }
        return true;
    }
    bool add_pair(int i, int k) noexcept {
        AxisValues x{};
        x[at(i)] = x[at(k)] = 1;
        JointsAt both{};
        if (!joints_at(x, both)) {
            return false;
        }
        for (std::size_t j = 0; j < at(m_.num_joints); ++j) {
            const double q2 = (both[j] - after_[at(i)][j] - after_[at(k)][j] + here_[j]) / (step_ * step_);
            keep(load_.q2[at(i)][at(k)][j], q2);
            load_.q2[at(k)][at(i)][j] = load_.q2[at(i)][at(k)][j];
        }
        return true;
    }
    bool add_together() noexcept {
        std::array<JointsAt, 4> q{};
        constexpr std::array<double, 4> STEPS{2, -2, 1, -1};
        for (std::size_t n = 0; n < q.size(); ++n) {
            AxisValues x{};
            for (int i = 0; i < load_.count; ++i) {
                x[at(i)] = STEPS[n] * load_.direction[at(i)];
            }
            if (!joints_at(x, q[n])) {
                return false;
            }
        }
        add_third(q[0], q[1], q[2], q[3], load_.q3_together);
        return true;
    }

    const TeleopMachine &m_;
    const geometry::Pose &pose_;
    JointLoad &load_;
    double step_;
    JointsAt here_{};
    std::array<JointsAt, MAX_AXES> after_{};
};

}  // namespace

bool add_pose(const TeleopMachine &m, const geometry::Pose &pose, JointLoad &load) noexcept {
    return Differences(m, pose, load).add();
}

AxisDemand allowed_demand(const TeleopMachine &m, const JointLoad &load, std::uint32_t members,
                          const AxisDemand &wanted) noexcept {
    AxisDemand out = wanted;
    for (int i = 0; i < load.count; ++i) {
        if ((members >> load.axes[at(i)] & 1U) == 0) {
            out.velocity[at(i)] = out.acceleration[at(i)] = out.jerk[at(i)] = 0;
        }
    }
    limit_alone(m, load, members, out);
    limit_speeds(m, load, members, out);
    limit_accelerations(m, load, members, out);
    limit_jerks(m, load, members, out);
    return out;
}

bool isWithinJoints(const TeleopMachine &m, const JointLoad &load, std::uint32_t members,
                    const AxisDemand &demand) noexcept {
    for (int j = 0; j < m.num_joints; ++j) {
        const JointTerms terms(load, members, j, CHECKED);
        const double v = terms.straight(demand.velocity);
        const double a = terms.straight(demand.acceleration) + terms.curve(demand.velocity, demand.velocity);
        const double jerk = terms.straight(demand.jerk) +
                            3 * terms.curve(demand.velocity, demand.acceleration) +
                            terms.turn(demand.velocity);
        if (v > m.joints.velocity[at(j)] || a > m.joints.acceleration[at(j)] || jerk > jerk_of(m, load, j)) {
            return false;
        }
    }
    return true;
}

}  // namespace mw::motion

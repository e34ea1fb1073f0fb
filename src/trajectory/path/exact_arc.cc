// SPDX-License-Identifier: GPL-2.0-or-later
#include "trajectory/path/exact_arc.hh"

#include <algorithm>
#include <cmath>

#include "trajectory/tuning.hh"

namespace mw::trajectory {
namespace {

/// Largest derivatives of coordinates and the XYZ norm on the full circles that an arc lies on.
void derivatives_of_circles(const Primitive &p, PerLimited &q1, PerLimited &q2) noexcept {
    const double w = std::abs(p.omega);
    const double drift = std::abs(p.dradius);
    const double radius = p.radius + std::max(0.0, p.dradius * p.length);
    q1.fill(0.0);
    q2.fill(0.0);
    const auto set = [&](std::size_t i, double round, double straight) {
        q1[i] = round * radius * w + straight;
        q2[i] = round * (radius * w * w + 2.0 * drift * w);
    };
    for (std::size_t i = 0; i < geometry::AXIS_COUNT; ++i) {
        const auto k = static_cast<int>(i) - p.space;
        const bool isRound = k >= 0 && k < 3;
        const auto n = static_cast<std::size_t>(isRound ? k : 0);
        set(i, isRound ? std::hypot(p.u[n], p.v[n]) : 0.0,
            std::abs(p.lin[static_cast<int>(i)]) + (isRound ? drift : 0.0));
    }
    if (p.space == geometry::AXIS_X) {
        set(XYZ_NORM, 1, geometry::norm_xyz(p.lin) + drift);
    }
}

/// Of one axis or joint.
struct Allowed {
    double acceleration = 0, jerk = 0;
};

/// Acceleration left along the arc at the speed v, for any direction.
double along_any_way(double q1, double q2, const Allowed &allowed, double v, double tau) noexcept {
    const double a =
        CornerTuning::ALONG_ACCELERATION * std::min(allowed.acceleration, allowed.jerk * tau) / q1;
    return q2 > 0 ? std::min(a, CornerTuning::ALONG_CROSS_JERK * allowed.jerk / (q2 * 3.0 * v)) : a;
}

/// The same where its derivatives are at most q1, q2 and q3, and the acceleration is built up in tau.
double along_this_way(double q1, double q2, double q3, const Allowed &allowed, double v,
                      double tau) noexcept {
    const double a = CornerTuning::ALONG_SHARE * allowed.acceleration - q2 * v * v;
    const double jerk = CornerTuning::ALONG_SHARE * allowed.jerk - q3 * v * v * v;
    return std::min(a / q1, jerk / (q1 / tau + 3.0 * q2 * v));
}

}  // namespace

bool isExactArc(const Primitive &p, const MoveRequest &request, const PathLimits &limits) noexcept {
    return limits.isFiltered() && p.isArc && request.join != geometry::PathMode::BLEND;
}

ExactArc::ExactArc(const PathStore &store, const Piece &stretch, const Conditions &conditions,
                   double wish) noexcept
    : store_(store), arc_(store.primitive(stretch.primitive)), wanted_(conditions.limits.wanted()),
      workspace_(conditions.workspace), tau_(conditions.limits.filter_s()), v_(wish) {
    derivatives_of_circles(arc_, q1_, q2_);
    for (std::size_t i = 0; i < q1_.size(); ++i) {
        if (q1_[i] > 0) {
            v_ = std::min(v_, wanted_.velocity[i] / q1_[i]);
        }
        if (q2_[i] > 0) {
            v_ = std::min(
                {v_, std::sqrt(CornerTuning::ALONG_TURNING * wanted_.acceleration[i] / q2_[i]),
                 std::cbrt(CornerTuning::ALONG_JERK * wanted_.jerk[i] / (q2_[i] * std::abs(arc_.omega)))});
        }
    }
    if (workspace_.isMapped()) {
        slow_down_for_joints(stretch);
    }
}

/// Joints move on the arc like axes, each on a separate curve.
void ExactArc::slow_down_for_joints(const Piece &stretch) noexcept {
    const JointLimits &joints = workspace_.joints;
    LimitRow rows[MAX_JOINTS];
    sample_rows(store_, stretch, workspace_, nullptr, rows);
    joint_k_.fill(std::abs(arc_.omega));
    for (std::size_t j = 0; j < joint_k_.size(); ++j) {
        const bool isMoving = rows[j].q1 > JointTuning::JITTER;
        joint_k_[j] = isMoving ? std::max(joint_k_[j], rows[j].q2 / rows[j].q1) : joint_k_[j];
        rows[j] = {};
    }
    sample_rows(store_, stretch, workspace_, joint_k_.data(), rows);
    for (std::size_t j = 0; j < static_cast<std::size_t>(joints.count); ++j) {
        const double q1 = rows[j].q1 * JointTuning::SAMPLING_MARGIN;
        const double k = joint_k_[j];
        joint_q1_[j] = q1;
        if (q1 > 0) {
            v_ = std::min({v_, joints.velocity[j] / q1,
                           std::sqrt(CornerTuning::ALONG_TURNING * joints.acceleration[j] / (q1 * k)),
                           std::cbrt(CornerTuning::ALONG_JERK * joints.jerk[j] / (q1 * k * k))});
        }
    }
}

// The acceleration of the reference counts at the averaged position, at most v tau away from the reference.
ExactArc::Seen ExactArc::seen(const Piece &part) const noexcept {
    const double reach = v_ * tau_;
    Piece wide = part;
    wide.offset = std::max(0.0, part.offset - reach);
    wide.length = std::min(arc_.length, part.offset + part.length + reach) - wide.offset;
    Seen seen{};
    derivative_bounds(arc_, wide.offset, wide.offset + wide.length, seen.q1, seen.q2);
    if (!workspace_.isMapped()) {
        return seen;
    }
    LimitRow rows[MAX_JOINTS];
    sample_rows(store_, wide, workspace_, nullptr, rows);
    for (std::size_t j = 0; j < static_cast<std::size_t>(workspace_.joints.count); ++j) {
        seen.joint_q1[j] = std::min(joint_q1_[j], rows[j].q1 * JointTuning::SAMPLING_MARGIN +
                                                      rows[j].q2 * wide.length / (JointTuning::SAMPLES - 1));
        seen.joint_q2[j] = rows[j].q2 * JointTuning::SAMPLING_MARGIN * JointTuning::SAMPLING_MARGIN;
    }
    return seen;
}

ExactArc::Allowance ExactArc::allowance_of(const Piece &part) const noexcept {
    const Seen here = seen(part);
    return {{v_, AccelBound::constant(acceleration_at(here, v_))}, braking_of(here)};
}

Braking ExactArc::braking_of(const Seen &part) const noexcept {
    Braking out{v_ * v_, false, {}};
    for (std::size_t k = 0; k <= AccelBound::LINES; ++k) {
        const double v = std::sqrt(LimitTuning::CHORDS[k]) * v_;
        // While the reference brakes, the command is faster by half of the speed that the reference loses in
        // tau.
        const double mean_v = std::min(v_, v + 0.5 * tau_ * acceleration_at(part, v));
        const double a = acceleration_at(part, mean_v) * (1.0 - LimitTuning::ACCELERATION_MARGIN);
        for (Braking::Part &to : out.parts) {
            to[k] = lesser_float(a);
        }
    }
    return out;
}

double ExactArc::acceleration_at(const Seen &part, double v) const noexcept {
    return std::min(acceleration_of_axes(part, v), acceleration_of_joints(part, v));
}

double ExactArc::acceleration_of_axes(const Seen &part, double v) const noexcept {
    const double w2 = arc_.omega * arc_.omega;
    double a = UNLIMITED;
    for (std::size_t i = 0; i < part.q1.size(); ++i) {
        if (!(q1_[i] > 0)) {
            continue;
        }
        const Allowed allowed{wanted_.acceleration[i], wanted_.jerk[i]};
        const double q3 = (part.q1[i] + 3.0 * std::abs(arc_.dradius)) * w2;
        const double here =
            part.q1[i] > 0 ? along_this_way(part.q1[i], part.q2[i], q3, allowed, v, tau_) : UNLIMITED;
        a = std::min(a, std::max(along_any_way(q1_[i], q2_[i], allowed, v, tau_), here));
    }
    return a;
}

double ExactArc::acceleration_of_joints(const Seen &part, double v) const noexcept {
    if (!workspace_.isMapped()) {
        return UNLIMITED;
    }
    const JointLimits &joints = workspace_.joints;
    double a = UNLIMITED;
    for (std::size_t j = 0; j < static_cast<std::size_t>(joints.count); ++j) {
        const double most = joint_q1_[j];
        if (!(most > 0)) {
            continue;
        }
        const double k = joint_k_[j];
        const Allowed allowed{joints.acceleration[j], joints.jerk[j]};
        const double least = along_any_way(most, most * k, allowed, v, tau_);
        const double q1 = part.joint_q1[j];
        const double here =
            q1 > 0 ? along_this_way(q1, part.joint_q2[j], most * k * k, allowed, v, tau_) : UNLIMITED;
        a = std::min(a, std::max(least, here));
    }
    return a;
}

}  // namespace mw::trajectory

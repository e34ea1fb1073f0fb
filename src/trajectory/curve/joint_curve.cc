// SPDX-License-Identifier: GPL-2.0-or-later
#include "trajectory/curve/joint_curve.hh"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace mw::trajectory::curve {

namespace {

constexpr std::size_t NODES = JointCurve::NODES;
/// A part that takes less time is not halved, because servo samples do not show its details.
constexpr double LEAST_PART_S = 1e-4;
/// Number of halvings after which a joint position that does not converge counts as a jump.
constexpr int MAX_DEPTH = 16;
/// Fraction of the jerk limit that the interpolation error may cause. It is within the margin of the profile.
constexpr double ERROR_SHARE = 3e-3;
/// Relative rounding error of the inverse kinematics.
constexpr double ROUNDING = 1e-13;
/// A joint jumps if the interpolation error exceeds this fraction of its change plus an absolute error that
/// no inverse kinematics has.
constexpr double JUMP_SHARE = 0.01, LEAST_JUMP = 1e-5;
/// The maximum third derivative of the Chebyshev polynomial of degree n is n^2 (n^2 - 1) (n^2 - 4)/15, at its
/// ends.
constexpr double THIRD_OF_ERROR = 49.0 * 48.0 * 45.0 / 15.0 * 8.0;
constexpr double LEAST = 1e-30;

using Matrix = std::array<std::array<double, NODES>, NODES>;

/// The Chebyshev nodes in [0, 1], and the matrix that calculates the coefficients of powers from the values
/// at the nodes.
struct Interpolation {
    std::array<double, NODES> x{};
    Matrix powers{};

    Interpolation() noexcept {
        for (std::size_t i = 0; i < NODES; ++i) {
            x[i] = 0.5 - 0.5 * std::cos(std::numbers::pi * (static_cast<double>(i) + 0.5) / NODES);
        }
        for (std::size_t i = 0; i < NODES; ++i) {
            // The Lagrange polynomial of node i, as coefficients of powers.
            std::array<double, NODES> p{1};
            std::size_t degree = 0;
            for (std::size_t j = 0; j < NODES; ++j) {
                if (j == i) {
                    continue;
                }
                const double per = 1 / (x[i] - x[j]);
                ++degree;
                for (std::size_t k = degree + 1; k-- > 0;) {
                    const double higher = k > 0 ? p[k - 1] : 0.0;
                    p[k] = (higher - x[j] * (k < degree ? p[k] : 0.0)) * per;
                }
            }
            for (std::size_t k = 0; k < NODES; ++k) {
                powers[k][i] = p[k];
            }
        }
    }
};

const Interpolation &interpolation() noexcept {
    static const Interpolation table;
    return table;
}

/// Value and first three derivatives of one joint by x.
std::array<double, 4> value_at(const JointCurve::Part &part, std::size_t joint, double x) noexcept {
    std::array<double, 4> v{};
    for (std::size_t k = NODES; k-- > 0;) {
        v[3] = v[3] * x + 3 * v[2];
        v[2] = v[2] * x + 2 * v[1];
        v[1] = v[1] * x + v[0];
        v[0] = v[0] * x + part.c[k][joint];
    }
    return v;
}

}  // namespace

void JointCurve::begin(const JointMap *map, const JointLimits &limits) noexcept {
    map_ = map;
    limits_ = limits;
    parts_.clear();
    largest_first_ = {};
    covered_s_ = -1e300;
    drivable_s_ = 1e300;
}

void JointCurve::cover(const std::vector<Span> &spans) {
    if (map_ == nullptr) {
        return;
    }
    const auto first = std::partition_point(spans.begin(), spans.end(),
                                            [&](const Span &s) { return s.start_s < covered_s_; });
    for (auto span = first; span != spans.end() && drivable_s_ == 1e300; ++span) {
        lay(*span, span->start_s, span->length, 0);
        covered_s_ = span->start_s + 0.5 * span->length;
    }
}

void JointCurve::drop_before(double s) {
    const auto first =
        std::partition_point(parts_.begin(), parts_.end(), [&](const Part &p) { return p.end_s() < s; });
    parts_.erase(parts_.begin(), first);
}

std::size_t JointCurve::part_at(double s) const noexcept {
    const auto behind =
        std::partition_point(parts_.begin(), parts_.end(), [&](const Part &p) { return p.start_s <= s; });
    return static_cast<std::size_t>(std::max<long>(0, behind - parts_.begin() - 1));
}

JointPoint JointCurve::point_at(std::size_t index, double s) const noexcept {
    const Part &part = parts_[index];
    const double per = 1 / part.length;
    const double x = (s - part.start_s) * per;
    JointPoint out;
    for (std::size_t j = 0; j < joints(); ++j) {
        const auto v = value_at(part, j, x);
        out.first[j] = v[1] * per;
        out.second[j] = v[2] * per * per;
        out.third[j] = v[3] * per * per * per;
    }
    return out;
}

bool JointCurve::interpolate(const Span &span, Part &part) const noexcept {
    const Interpolation &table = interpolation();
    std::array<PerJoint, NODES> at{};
    for (std::size_t i = 0; i < NODES; ++i) {
        const Pose pose = position_at(span, part.start_s + part.length * table.x[i]);
        if (!map_->joints_at(pose, at[i].data())) {
            return false;
        }
    }
    // Differences to the value at the first node keep rounding errors of large values out of the higher
    // powers.
    const PerJoint origin = at[0];
    for (std::size_t j = 0; j < joints(); ++j) {
        for (std::size_t k = 0; k < NODES; ++k) {
            double sum = 0;
            for (std::size_t i = 0; i < NODES; ++i) {
                sum += table.powers[k][i] * (at[i][j] - origin[j]);
            }
            part.c[k][j] = sum + (k == 0 ? origin[j] : 0.0);
        }
    }
    return true;
}

double JointCurve::speed_at(const Part &part, double x) const noexcept {
    double v = 1e300;
    for (std::size_t j = 0; j < joints(); ++j) {
        const auto at = value_at(part, j, x);
        v = std::min({v, limits_.velocity[j] / std::max(std::abs(at[1]), LEAST),
                      std::sqrt(limits_.acceleration[j] / std::max(std::abs(at[2]), LEAST)),
                      std::cbrt(limits_.jerk[j] / std::max(std::abs(at[3]), LEAST))});
    }
    return v * part.length;
}

/// Jerk of the interpolation error divided by its permitted part of the jerk limit. `jump`: error divided by
/// that of a jump; a joint jumps above 1.
double JointCurve::error_of(const Span &span, const Part &part, double &jump) const noexcept {
    double worst = 0;
    jump = 0;
    // The error has its maximum at the ends.
    for (const double x : {0.0, 1.0}) {
        PerJoint at{};
        if (!map_->joints_at(position_at(span, part.start_s + part.length * x), at.data())) {
            jump = 1e300;
            return 1e300;
        }
        const double v = std::max(speed_at(part, x), speed_at(part, 0.5)) / part.length;
        for (std::size_t j = 0; j < joints(); ++j) {
            const double error = std::abs(value_at(part, j, x)[0] - at[j]);
            const double change = std::abs(value_at(part, j, 1)[0] - value_at(part, j, 0)[0]);
            const double least = ROUNDING * (1 + std::abs(at[j]));
            jump = std::max(jump, error / (LEAST_JUMP + JUMP_SHARE * change));
            if (error > least) {
                worst = std::max(worst, THIRD_OF_ERROR * error * v * v * v / (ERROR_SHARE * limits_.jerk[j]));
            }
        }
    }
    return worst;
}

void JointCurve::lay(const Span &span, double from, double length, int depth) {
    if (drivable_s_ < 1e300) {
        return;
    }
    Part part;
    part.start_s = from;
    part.length = length;
    double jump = 1e300;
    const bool exists = interpolate(span, part);
    const double error = exists ? error_of(span, part, jump) : 1e300;
    const double fastest =
        exists ? std::max({speed_at(part, 0), speed_at(part, 0.5), speed_at(part, 1)}) : 0.0;
    if (error > 1 && depth < MAX_DEPTH && length > LEAST_PART_S * fastest) {
        lay(span, from, 0.5 * length, depth + 1);
        lay(span, from + 0.5 * length, 0.5 * length, depth + 1);
        return;
    }
    if (jump > 1) {
        drivable_s_ = from;
        return;
    }
    // The maximum speed of a joint motion with the length and the bounds of this part.
    double v = std::min({speed_at(part, 0), speed_at(part, 0.5), speed_at(part, 1)});
    for (std::size_t j = 0; j < joints(); ++j) {
        const double most = std::max({std::abs(value_at(part, j, 0)[1]), std::abs(value_at(part, j, 0.5)[1]),
                                      std::abs(value_at(part, j, 1)[1]), LEAST});
        largest_first_[j] = std::max(largest_first_[j], most / length);
        v = std::min({v, std::sqrt(limits_.acceleration[j] / most) * length,
                      std::cbrt(limits_.jerk[j] / most) * length});
    }
    part.speed = v;
    parts_.push_back(part);
}

namespace {

/// The parabola with the position and derivatives of a point.
Pose parabola(const CurvePoint &p, double t) noexcept {
    return p.position + p.first * t + p.second * (0.5 * t * t);
}

}  // namespace

JointJump joint_jump(const CurvePoint &before, const CurvePoint &after, const JointMap &map) noexcept {
    // The step is the same on both sides, so errors of the differences along the common direction cancel.
    constexpr double STEP = 1e-3;
    JointJump jump;
    PerJoint at{}, low0{}, high0{}, low1{}, high1{};
    jump.exists = map.joints_at(before.position, at.data()) &&
                  map.joints_at(parabola(before, -STEP), low0.data()) &&
                  map.joints_at(parabola(before, STEP), high0.data()) &&
                  map.joints_at(parabola(after, -STEP), low1.data()) &&
                  map.joints_at(parabola(after, STEP), high1.data());
    for (std::size_t j = 0; j < MAX_JOINTS && jump.exists; ++j) {
        jump.before[j] = std::abs(high0[j] - low0[j]) / (2 * STEP);
        jump.after[j] = std::abs(high1[j] - low1[j]) / (2 * STEP);
        jump.first[j] = std::abs((high1[j] - low1[j]) - (high0[j] - low0[j])) / (2 * STEP);
        jump.second[j] = std::abs((high1[j] + low1[j]) - (high0[j] + low0[j])) / (STEP * STEP);
    }
    return jump;
}

}  // namespace mw::trajectory::curve

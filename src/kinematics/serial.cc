// SPDX-License-Identifier: GPL-2.0-or-later
#include "kinematics/serial.hh"

#include <algorithm>
#include <iterator>

namespace mw::kinematics {

namespace {

constexpr double NEARLY_SINGULAR = 1e-4;

/// The x that minimises the error of m x = left while x is small (Wampler's damped least squares, 1986).
Row<6> damped_step(const Square<6> &m, const Row<6> &left) noexcept {
    constexpr double DAMPING = 1e-3;
    Square<6> normal{};
    Row<6> out{};
    for (std::size_t i = 0; i < 6; ++i) {
        for (std::size_t k = 0; k < 6; ++k) {
            for (std::size_t r = 0; r < 6; ++r) {
                normal[i][k] += m[r][i] * m[r][k];
            }
            out[i] += m[k][i] * left[k];
        }
        normal[i][i] += square(DAMPING);
    }
    solve(normal, out);
    return out;
}

/// The axis and angle [rad] that rotate `from` to `to`.
Vector turn_between(const Rotation &from, const Rotation &to) noexcept {
    const Vector twice_sine = cross(from.x, to.x) + cross(from.y, to.y) + cross(from.z, to.z);
    const double cosine_angle = 0.5 * (dot(from.x, to.x) + dot(from.y, to.y) + dot(from.z, to.z) - 1.0);
    const double sine_angle = 0.5 * length(twice_sine);
    if (sine_angle > 1e-9) {
        return twice_sine * (0.5 * std::atan2(sine_angle, cosine_angle) / sine_angle);
    }
    if (cosine_angle > 0) {
        return twice_sine * 0.5;
    }
    // For a rotation by 180 degrees the axis is the sum of a vector and its rotated image.
    const Vector sums[] = {from.x + to.x, from.y + to.y, from.z + to.z};
    const Vector *largest =
        std::max_element(std::begin(sums), std::end(sums),
                         [](const Vector &a, const Vector &b) { return dot(a, a) < dot(b, b); });
    return direction(*largest) * std::numbers::pi;
}

}  // namespace

/// Rotation of each row of the table [degrees]; includes the contribution of the joint before it.
Row<Serial::JOINTS> Serial::angles_of(const double *joints) const noexcept {
    Row<JOINTS> out{};
    for (std::size_t i = 0; i < JOINTS; ++i) {
        out[i] = joints[i] + (i > 0 ? get(index_of(UNROTATE, i)) * joints[i - 1] : 0.0);
    }
    return out;
}

Serial::Chain Serial::chain_of(const Row<JOINTS> &angles) const noexcept {
    Chain out;
    Place at;
    for (std::size_t i = 0; i < JOINTS; ++i) {
        const double alpha = get(index_of(ALPHA, i));
        const double c = std::cos(alpha);
        const double s = std::sin(alpha);
        at.point = at.point + at.turn.x * get(index_of(A, i));
        const Rotation tilted{at.turn.x, at.turn.y * c + at.turn.z * s, at.turn.z * c - at.turn.y * s};
        const double ct = cosine(angles[i]);
        const double st = sine(angles[i]);
        at.turn = {tilted.x * ct + tilted.y * st, tilted.y * ct - tilted.x * st, tilted.z};
        at.point = at.point + at.turn.z * get(index_of(D, i));
        out.origins[i] = at.point;
        out.axes[i] = at.turn.z;
    }
    out.hand = at;
    return out;
}

double Serial::size() const noexcept {
    double sum = 0;
    for (std::size_t i = 0; i < JOINTS; ++i) {
        sum += std::abs(get(index_of(A, i))) + std::abs(get(index_of(D, i)));
    }
    return std::max(sum, 1e-9);
}

Status Serial::forward(const double *joints, Pose &pose) const noexcept {
    const Chain chain = chain_of(angles_of(joints));
    if (!areFinite(joints, geometry::AXIS_COUNT) || !isFinite(chain.hand.point)) {
        return Status::UNREACHABLE;
    }
    set_place(pose, chain.hand.point);
    set_rotation(pose, chain.hand.turn);
    std::copy_n(joints + JOINTS, 3, pose.c.begin() + geometry::AXIS_U);
    return Status::OK;
}

/// One Newton step. `miss` is the error before it, relative to the arm's size or in radians. Returns the
/// distance of the equations from a singularity.
double Serial::approach(const Place &target, Row<JOINTS> &angles, double &miss) const noexcept {
    const Chain chain = chain_of(angles);
    const double scale = 1.0 / size();
    const Vector off = (target.point - chain.hand.point) * scale;
    const Vector turn = turn_between(chain.hand.turn, target.turn);
    miss = std::max(length(off), length(turn));
    Square<JOINTS> m{};
    for (std::size_t i = 0; i < JOINTS; ++i) {
        const Vector move = cross(chain.axes[i], chain.hand.point - chain.origins[i]) * scale;
        const Vector &axis = chain.axes[i];
        const double column[] = {move.x, move.y, move.z, axis.x, axis.y, axis.z};
        for (std::size_t r = 0; r < JOINTS; ++r) {
            m[r][i] = column[r];
        }
    }
    const Row<JOINTS> left{off.x, off.y, off.z, turn.x, turn.y, turn.z};
    Row<JOINTS> step = left;
    const double pivot = solve(m, step);
    if (pivot < NEARLY_SINGULAR) {
        step = damped_step(m, left);
    }
    const double largest = std::abs(*std::max_element(
        step.begin(), step.end(), [](double a, double b) { return std::abs(a) < std::abs(b); }));
    constexpr double LARGEST_STEP_RAD = 0.3;
    const double share = std::min(1.0, LARGEST_STEP_RAD / std::max(largest, 1e-300));
    for (std::size_t i = 0; i < JOINTS; ++i) {
        angles[i] += step[i] * share * DEGREES;
    }
    return pivot;
}

bool Serial::reach(const Place &target, Row<JOINTS> &angles, int &iterations, double &pivot) const noexcept {
    constexpr double CLOSE = 1e-13;
    constexpr double MOST_ITERATIONS = 1000;
    const int limit = static_cast<int>(std::min(get(MAX_ITERATIONS), MOST_ITERATIONS));
    double before = 1e300;
    for (int n = 0; n < limit; ++n) {
        double miss = 0;
        const Row<JOINTS> last = angles;
        pivot = approach(target, angles, miss);
        // When a small error does not decrease, only rounding errors remain.
        const bool settled = miss < CLOSE || (miss < 1e-10 && miss >= 0.5 * before);
        if (settled) {
            angles = last;
            return true;
        }
        before = miss;
        ++iterations;
    }
    return false;
}

Status Serial::inverse(const Pose &pose, double *joints) const noexcept {
    int iterations = 0;
    return inverse(pose, joints, iterations);
}

Status Serial::inverse(const Pose &pose, double *joints, int &iterations) const noexcept {
    iterations = 0;
    if (!isFinite(pose) || !areFinite(joints, JOINTS)) {
        return Status::UNREACHABLE;
    }
    Row<JOINTS> angles = angles_of(joints);
    const Place start = chain_of(angles).hand;
    const Place end{place_of(pose), rotation_of(pose)};
    const Vector turn = turn_between(start.turn, end.turn);
    const Vector way = end.point - start.point;
    constexpr double STRIDE = 0.1;  // fraction of the size, or radians
    constexpr int MAX_STRIDES = 64;
    const double strides = std::ceil(std::max(length(way) / size(), length(turn)) / STRIDE);
    const int count = static_cast<int>(std::clamp(strides, 1.0, static_cast<double>(MAX_STRIDES)));
    double pivot = 0;
    for (int n = 1; n <= count; ++n) {
        const double share = static_cast<double>(n) / count;
        const Place target =
            n == count ? end : Place{start.point + way * share, rotation_about(turn * share) * start.turn};
        if (!reach(target, angles, iterations, pivot)) {
            return Status::UNREACHABLE;
        }
    }
    for (std::size_t i = 0; i < JOINTS; ++i) {
        joints[i] = angles[i] - (i > 0 ? get(index_of(UNROTATE, i)) * joints[i - 1] : 0.0);
    }
    std::copy_n(pose.c.begin() + geometry::AXIS_U, 3, joints + JOINTS);
    return pivot > SINGULAR_PIVOT ? Status::OK : Status::SINGULAR;
}

}  // namespace mw::kinematics

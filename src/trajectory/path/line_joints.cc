// SPDX-License-Identifier: GPL-2.0-or-later
#include "trajectory/path/line_joints.hh"

#include <algorithm>
#include <array>
#include <cmath>

#include "trajectory/tuning.hh"

namespace mw::trajectory {

namespace {

using Joints = std::array<double, MAX_JOINTS>;
using Tuning = LineJointTuning;

/// Derivatives at x from finite differences of five samples: at[n + 2] is q(x + n h).
LineJoints::Row derivatives(const std::array<Joints, 5> &at, std::size_t j, double h) noexcept {
    const auto q = [&](int n) { return at[static_cast<std::size_t>(n + 2)][j]; };
    const auto above = [](double value, double rounding) {
        return std::max(0.0, std::abs(value) - rounding);
    };
    // Error of a sample.
    const double noise = Tuning::ROUNDING * (1.0 + std::abs(q(0)));
    return {std::abs(q(1) - q(-1)) / (2.0 * h), above(q(1) - 2.0 * q(0) + q(-1), 4.0 * noise) / (h * h),
            above(q(2) - 2.0 * q(1) + 2.0 * q(-1) - q(-2), 6.0 * noise) / (2.0 * h * h * h)};
}

}  // namespace

LineJoints joints_along(const Workspace &workspace, const Primitive &line, double from, double to) noexcept {
    LineJoints out;
    const double h = Tuning::STEP;
    const double gap = (to - from) / (Tuning::PLACES - 1);
    for (int n = 0; n < Tuning::PLACES; ++n) {
        std::array<Joints, 5> at{};
        for (std::size_t k = 0; k < at.size(); ++k) {
            const double x = from + gap * n + h * (static_cast<double>(k) - 2.0);
            if (!workspace.map->joints_at(line.start + line.lin * x, at[k].data())) {
                return {};
            }
        }
        for (std::size_t j = 0; j < static_cast<std::size_t>(workspace.joints.count); ++j) {
            const LineJoints::Row here = derivatives(at, j, h);
            LineJoints::Row &row = out.rows[j];
            row = {std::max(row.q1, here.q1), std::max(row.q2, here.q2), std::max(row.q3, here.q3)};
        }
    }
    for (LineJoints::Row &row : out.rows) {
        // Between two samples, a derivative can change by the next derivative times half of their distance.
        row.q3 *= Tuning::MARGIN;
        row.q2 = Tuning::MARGIN * row.q2 + 0.5 * gap * row.q3;
        row.q1 = Tuning::MARGIN * row.q1 + 0.5 * gap * row.q2;
    }
    out.isReachable = true;
    return out;
}

double LineJoints::most_speed(const JointLimits &joints) const noexcept {
    double v = UNLIMITED;
    for (std::size_t j = 0; j < static_cast<std::size_t>(joints.count); ++j) {
        const Row &row = rows[j];
        v = row.q1 > 0 ? std::min(v, joints.velocity[j] / row.q1) : v;
        v = row.q2 > 0 ? std::min(v, std::sqrt(Tuning::TURNING * joints.acceleration[j] / row.q2)) : v;
        v = row.q3 > 0 ? std::min(v, std::cbrt(Tuning::TURNING * joints.jerk[j] / row.q3)) : v;
    }
    return v;
}

// Limits of a joint, with x the position along the line: q' x'' + q'' x'^2 <= A and
// q' x''' + 3 q'' x' x'' + q''' x'^3 <= J.
MotionLimits LineJoints::limits_at(const JointLimits &joints, double v, bool has_jerk_limits) const noexcept {
    MotionLimits out{v, UNLIMITED, UNLIMITED};
    const auto count = static_cast<std::size_t>(joints.count);
    const auto jerk_left = [&](std::size_t j) {
        return std::max(0.0, joints.jerk[j] - rows[j].q3 * v * v * v);
    };
    for (std::size_t j = 0; j < count; ++j) {
        const Row &row = rows[j];
        if (row.q1 > 0) {
            const double left = std::max(0.0, joints.acceleration[j] - row.q2 * v * v);
            out.acceleration = std::min(out.acceleration, left / row.q1);
        }
        if (has_jerk_limits && row.q2 * v > 0) {
            out.acceleration =
                std::min(out.acceleration, Tuning::CROSS_SHARE * jerk_left(j) / (3.0 * row.q2 * v));
        }
    }
    for (std::size_t j = 0; has_jerk_limits && j < count; ++j) {
        if (rows[j].q1 > 0) {
            const double left = jerk_left(j) - 3.0 * rows[j].q2 * v * out.acceleration;
            out.jerk = std::min(out.jerk, left / rows[j].q1);
        }
    }
    return {v, Tuning::FULL * out.acceleration, has_jerk_limits ? Tuning::FULL * out.jerk : UNLIMITED};
}

}  // namespace mw::trajectory

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

/// Derivatives by differences over five places around x, where q(x + n h) is at[n + 2].
LineJoints::Row derivatives(const std::array<Joints, 5> &at, std::size_t j, double h) noexcept {
    const auto q = [&](int n) { return at[static_cast<std::size_t>(n + 2)][j]; };
    const auto above = [](double value, double rounding) {
        return std::max(0.0, std::abs(value) - rounding);
    };
    // Accuracy of a joint position from the samples.
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
        // Each grows by the next one from a place to the middle between two.
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

// With x the way along the line: q' x'' + q'' x'^2 <= A; q' x''' + 3 q'' x' x'' + q''' x'^3 <= J, and the
// mean of an acceleration that swings by 2 a within tau has x''' <= 2 a / tau.
double LineJoints::acceleration(const JointLimits &joints, double v, double filter_s) const noexcept {
    double a = UNLIMITED;
    for (std::size_t j = 0; j < static_cast<std::size_t>(joints.count); ++j) {
        const Row &row = rows[j];
        if (row.q1 > 0) {
            a = std::min(a, std::max(0.0, joints.acceleration[j] - row.q2 * v * v) / row.q1);
        }
        const double swing = filter_s > 0 ? 2.0 * row.q1 / filter_s + 3.0 * row.q2 * v : 0.0;
        if (swing > 0) {
            a = std::min(a, std::max(0.0, joints.jerk[j] - row.q3 * v * v * v) / swing);
        }
    }
    return a;
}

}  // namespace mw::trajectory

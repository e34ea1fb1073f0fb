// SPDX-License-Identifier: GPL-2.0-or-later
#include "traj/path_cut.hh"

#include <algorithm>
#include <cmath>

namespace mw::bench {

namespace {

constexpr double FINEST = 0.004, COARSEST = 0.02, POINTS = 120000;
constexpr double REVERSAL = -0.9;

}  // namespace

Path cut_path(const Program &program) {
    double length = 0;
    Pose from = program.start;
    for (const Move &m : program.moves) {
        const double around = m.isArc ? std::abs(m.angle_rad) * geometry::norm_xyz(from - m.centre) : 0.0;
        length += std::max(around, geometry::norm(m.end - from));
        from = m.end;
    }
    const double step = std::clamp(length / POINTS, FINEST, COARSEST);
    Path path;
    path.points.push_back(program.start);
    path.feed.push_back(0);
    path.isStop.push_back(true);
    path.isFixed.push_back(true);
    from = program.start;
    Pose last_tangent;
    for (const Move &m : program.moves) {
        const double around = m.isArc ? std::abs(m.angle_rad) * geometry::norm_xyz(from - m.centre) : 0.0;
        const int n =
            std::max(2, static_cast<int>(std::ceil(std::max(around, geometry::norm(m.end - from)) / step)));
        const Pose out = position_on(from, m, 1e-6) - from;
        const Pose tangent = out * (1.0 / geometry::norm(out));
        const double turn = geometry::dot(tangent, last_tangent);
        const bool isExactCorner = m.control == geometry::PathMode::EXACT_PATH && turn < 0.9998;
        if (isExactCorner || m.control == geometry::PathMode::EXACT_STOP || turn < REVERSAL) {
            path.isStop.back() = true;
        }
        const double moved = geometry::norm(m.end - from);
        const double xyz = geometry::norm_xyz(m.end - from);
        const double ratio = m.isArc || !(xyz > 0) ? 1.0 : moved / xyz;
        for (int i = 1; i <= n; ++i) {
            path.points.push_back(position_on(from, m, static_cast<double>(i) / n));
            path.feed.push_back(m.feed * ratio);
            path.isStop.push_back(false);
            path.isFixed.push_back(m.control != geometry::PathMode::BLEND);
        }
        const Pose in = m.end - position_on(from, m, 1.0 - 1e-6);
        last_tangent = in * (1.0 / geometry::norm(in));
        from = m.end;
    }
    path.isStop.back() = true;
    return path;
}

double distance(const Pose &a, const Pose &b) {
    const Pose d = a - b;
    return std::max(geometry::norm_linear(d), geometry::norm_abc(d));
}

}  // namespace mw::bench

// SPDX-License-Identifier: GPL-2.0-or-later
#include "traj/bound.hh"

#include <algorithm>
#include <cmath>

#include "traj/path_cut.hh"

namespace mw::bench {

namespace {

/// Moves each point to the weighted mean of itself and its neighbours, `count` times, at most P from its
/// original position.
void smooth(const std::vector<Pose> &original, const Path &path, double tolerance, int count,
            std::vector<Pose> &p) {
    for (int n = 0; n < count; ++n) {
        Pose before = p[0];
        for (std::size_t i = 1; i + 1 < p.size(); ++i) {
            const Pose old = p[i];
            if (!path.isFixed[i] && !path.isStop[i]) {
                Pose to = (before + p[i + 1]) * 0.25 + p[i] * 0.5;
                const double off = distance(to, original[i]);
                if (off > tolerance) {
                    to = original[i] + (to - original[i]) * (tolerance / off);
                }
                p[i] = to;
            }
            before = old;
        }
    }
}

/// First and second derivatives of the coordinates along the path at a point.
struct Cell {
    Pose q1, q2;
};
/// Allowed accelerations along the path at the squared speed b: low <= a <= high. False if there are none.
bool range_of(const Cell &c, const Program &program, double b, double &low, double &high) {
    low = -1e300;
    high = 1e300;
    for (int i = 0; i < geometry::AXIS_COUNT; ++i) {
        const double limit = program.max_acceleration[i];
        const double turning = c.q2[i] * b;
        if (std::abs(c.q1[i]) < 1e-9) {
            if (std::abs(turning) > limit) {
                return false;
            }
            continue;
        }
        const double one = (-limit - turning) / c.q1[i];
        const double two = (limit - turning) / c.q1[i];
        low = std::max(low, std::min(one, two));
        high = std::min(high, std::max(one, two));
    }
    return low <= high;
}

double time_of(const std::vector<Pose> &p, const Path &path, const Program &program) {
    const std::size_t n = p.size();
    std::vector<Cell> cells(n);
    std::vector<double> gap(n, 0.0);
    std::vector<double> most(n, 0.0);
    for (std::size_t i = 0; i + 1 < n; ++i) {
        gap[i] = std::max(1e-9, geometry::norm(p[i + 1] - p[i]));
    }
    for (std::size_t i = 1; i + 1 < n; ++i) {
        const Pose in = (p[i] - p[i - 1]) * (1.0 / gap[i - 1]);
        const Pose out = (p[i + 1] - p[i]) * (1.0 / gap[i]);
        cells[i] = {(in + out) * 0.5, (out - in) * (2.0 / (gap[i] + gap[i - 1]))};
        double v = path.feed[i] > 0 ? path.feed[i] : 1e300;
        for (int k = 0; k < geometry::AXIS_COUNT; ++k) {
            v = std::abs(cells[i].q1[k]) > 0 ? std::min(v, program.max_velocity[k] / std::abs(cells[i].q1[k]))
                                             : v;
        }
        most[i] = path.isStop[i] ? 0.0 : v * v;
    }
    for (std::size_t i = n - 1; i-- > 1;) {
        // The maximum b at which an allowed acceleration reaches the feasible range of the next point.
        double low_b = 0;
        double high_b = most[i];
        for (int k = 0; k < 50 && high_b > 0; ++k) {
            const double b = k == 0 ? high_b : 0.5 * (low_b + high_b);
            double low = 0;
            double high = 0;
            const bool isKept =
                range_of(cells[i], program, b, low, high) && b + 2.0 * low * gap[i] <= most[i + 1];
            (isKept ? low_b : high_b) = b;
            if (k == 0 && isKept) {
                break;
            }
        }
        most[i] = low_b;
    }
    std::vector<double> b(n, 0.0);
    double time = 0;
    for (std::size_t i = 0; i + 1 < n; ++i) {
        double low = 0;
        double high = 0;
        Cell c = cells[i];
        if (i == 0 || path.isStop[i]) {
            c = {(p[i + 1] - p[i]) * (1.0 / gap[i]), Pose{}};
        }
        range_of(c, program, b[i], low, high);
        b[i + 1] = std::clamp(b[i] + 2.0 * high * gap[i], 0.0, most[i + 1]);
        const double sum = std::sqrt(b[i]) + std::sqrt(b[i + 1]);
        time += sum > 0 ? 2.0 * gap[i] / sum : 1e3;
    }
    return time;
}

}  // namespace

double best_known_time(const Program &program) {
    const Path path = cut_path(program);
    std::vector<Pose> points = path.points;
    double best = 1e300;
    int done = 0;
    for (const int count : {0, 4, 12, 36, 108, 324, 972, 2400}) {
        smooth(path.points, path, program.tolerance, count - done, points);
        done = count;
        best = std::min(best, time_of(points, path, program));
    }
    return best;
}

}  // namespace mw::bench

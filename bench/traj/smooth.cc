// SPDX-License-Identifier: GPL-2.0-or-later
// Smooth curves within P of the programmed path. Each point becomes a weighted average of its neighbourhood.
// Its width is the largest that stays within P and changes slowly from point to point.
#include <algorithm>
#include <cmath>

#include "traj/jerk_bound.hh"

namespace mw::bench {

namespace {

constexpr double USED_TOLERANCE = 0.97;
constexpr double NARROWER = 0.85;
constexpr double SLOPE = 0.3;  ///< maximum change of the width from one point to the next
constexpr int ROUNDS = 60;

/// (1 - x^2)^4: its first three derivatives are zero at the ends.
double kernel(double x) {
    const double y = 1.0 - x * x;
    return y > 0 ? y * y * y * y : 0.0;
}

Pose mean_at(const std::vector<Pose> &p, std::size_t i, double width) {
    const auto reach = static_cast<std::size_t>(width);
    Pose sum = p[i];
    double weight = 1;
    for (std::size_t k = 1; k <= reach; ++k) {
        const double w = kernel(static_cast<double>(k) / width);
        sum = sum + (p[i - k] + p[i + k]) * w;
        weight += 2.0 * w;
    }
    return sum * (1.0 / weight);
}

void limit_slope(std::vector<double> &width) {
    for (std::size_t i = 1; i < width.size(); ++i) {
        width[i] = std::min(width[i], width[i - 1] + SLOPE);
    }
    for (std::size_t i = width.size() - 1; i-- > 0;) {
        width[i] = std::min(width[i], width[i + 1] + SLOPE);
    }
}

std::vector<Pose> smoothed(const Path &path, double tolerance, double widest) {
    const std::size_t n = path.points.size();
    std::vector<double> width(n, widest);
    for (std::size_t i = 0; i < n; ++i) {
        if (path.isFixed[i] || path.isStop[i]) {
            width[i] = 0;
        }
    }
    limit_slope(width);
    std::vector<Pose> out = path.points;
    std::vector<double> done(n, -1.0);
    for (int round = 0; round < ROUNDS; ++round) {
        bool isWithin = true;
        for (std::size_t i = 0; i < n; ++i) {
            if (width[i] == done[i]) {
                continue;
            }
            done[i] = width[i];
            out[i] = width[i] >= 1.0 ? mean_at(path.points, i, width[i]) : path.points[i];
            if (distance(out[i], path.points[i]) > USED_TOLERANCE * tolerance) {
                width[i] *= NARROWER;
                isWithin = false;
            }
        }
        if (isWithin) {
            break;
        }
        limit_slope(width);
    }
    for (std::size_t i = 0; i < n; ++i) {
        if (distance(out[i], path.points[i]) > tolerance) {
            out[i] = path.points[i];
        }
    }
    return out;
}

/// Lagrange's cubic through the points around [k, k + 1].
Pose cubic(const std::vector<Pose> &p, const std::vector<double> &along, std::size_t k, double s) {
    const std::size_t first = std::min(k > 0 ? k - 1 : 0, p.size() > 4 ? p.size() - 4 : 0);
    const std::size_t count = std::min<std::size_t>(4, p.size());
    Pose sum;
    for (std::size_t i = first; i < first + count; ++i) {
        double w = 1;
        for (std::size_t j = first; j < first + count; ++j) {
            w *= j == i ? 1.0 : (s - along[j]) / (along[i] - along[j]);
        }
        sum = sum + p[i] * w;
    }
    return sum;
}

/// Evenly spaced points along a polyline.
Stretch evenly(const std::vector<Pose> &points, const std::vector<Pose> &programmed,
               const std::vector<double> &feed, double step) {
    std::vector<double> along{0};
    for (std::size_t i = 1; i < points.size(); ++i) {
        along.push_back(along.back() + geometry::norm(points[i] - points[i - 1]));
    }
    const double length = along.back();
    const auto n = static_cast<std::size_t>(std::max(4.0, std::ceil(length / step)));
    Stretch out;
    out.step = length / static_cast<double>(n);
    std::size_t k = 0;
    for (std::size_t i = 0; i <= n; ++i) {
        const double s = length * static_cast<double>(i) / static_cast<double>(n);
        while (k + 2 < along.size() && along[k + 1] < s) {
            ++k;
        }
        out.points.push_back(i == n ? points.back() : cubic(points, along, k, s));
        const double part = std::clamp((s - along[k]) / (along[k + 1] - along[k]), 0.0, 1.0);
        out.programmed.push_back(programmed[k] * (1.0 - part) + programmed[k + 1] * part);
        out.feed.push_back(feed[k + 1]);
    }
    return out;
}

}  // namespace

std::vector<Stretch> smooth_stretches(const Path &path, double tolerance, double widest) {
    const std::vector<Pose> p = smoothed(path, tolerance, widest);
    std::vector<Stretch> out;
    std::vector<Pose> points;
    std::vector<Pose> programmed;
    std::vector<double> feed;
    double gap = 0;
    for (std::size_t i = 0; i < p.size(); ++i) {
        points.push_back(p[i]);
        programmed.push_back(path.points[i]);
        feed.push_back(path.feed[i]);
        gap = i > 0 ? std::max(gap, geometry::norm(path.points[i] - path.points[i - 1])) : gap;
        if (i > 0 && path.isStop[i]) {
            out.push_back(evenly(points, programmed, feed, gap));
            out.back().isExact = path.isFixed[i - 1];
            points = {p[i]};
            programmed = {path.points[i]};
            feed = {path.feed[i]};
            gap = 0;
        }
    }
    return out;
}

}  // namespace mw::bench

// SPDX-License-Identifier: GPL-2.0-or-later
// Deviation between a trajectory and the programmed path, in both directions and in order: the discrete
// Frechet distance of two finely divided polylines.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "base/geometry/pose.hh"

namespace mw::testing {

/// Lengths and degrees are each compared with the tolerance, as G64 P does.
inline double pose_distance(const geometry::Pose &a, const geometry::Pose &b) {
    const geometry::Pose d = a - b;
    return std::max(geometry::norm_linear(d), geometry::norm_abc(d));
}

/// The polyline with points at most `step` apart.
inline std::vector<geometry::Pose> refined(const std::vector<geometry::Pose> &points, double step) {
    std::vector<geometry::Pose> out;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const int n =
            i == 0 ? 1
                   : std::max(1, static_cast<int>(std::ceil(pose_distance(points[i], points[i - 1]) / step)));
        for (int k = 1; k < n; ++k) {
            out.push_back(points[i - 1] + (points[i] - points[i - 1]) * (static_cast<double>(k) / n));
        }
        out.push_back(points[i]);
    }
    return out;
}

/// True if both polylines can be followed from start to end without going back, at most `tolerance` apart.
inline bool isWithinInOrder(const std::vector<geometry::Pose> &samples,
                            const std::vector<geometry::Pose> &path, double tolerance) {
    std::vector<std::size_t> reach{0};
    std::vector<std::size_t> next;
    if (pose_distance(samples[0], path[0]) > tolerance) {
        return false;
    }
    for (const geometry::Pose &s : samples) {
        next.clear();
        for (const std::size_t j : reach) {
            // With this sample the tool stays at its point of the path or advances by one point, and further
            // while the next points are near the sample.
            const std::size_t seen = next.empty() ? 0 : next.back() + 1;
            std::size_t k = std::max(j, seen);
            if (k == j && pose_distance(s, path[j]) > tolerance) {
                ++k;
            }
            const bool isReached = k <= j + 1 || (!next.empty() && next.back() + 1 == k);
            while (isReached && k < path.size() && pose_distance(s, path[k]) <= tolerance) {
                next.push_back(k++);
            }
        }
        if (next.empty()) {
            return false;
        }
        reach.swap(next);
    }
    return reach.back() == path.size() - 1;
}

/// The deviation, to a few per cent and within `step`; `highest` when it is larger than that.
inline double deviation_in_order(const std::vector<geometry::Pose> &samples,
                                 const std::vector<geometry::Pose> &path, double step, double highest) {
    const std::vector<geometry::Pose> a = refined(samples, step);
    const std::vector<geometry::Pose> b = refined(path, step);
    double low = 0;
    double high = highest;
    while (high - low > std::max(0.02 * high, 0.25 * step)) {
        const double middle = 0.5 * (low + high);
        (isWithinInOrder(a, b, middle) ? high : low) = middle;
    }
    return high;
}

}  // namespace mw::testing

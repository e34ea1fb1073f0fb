// SPDX-License-Identifier: GPL-2.0-or-later
// A path as a function of its length, smooth between stops.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "traj/jerk_bound.hh"

namespace mw::bench {

/// Quintic B-spline: the sum over k of (-1)^k C(6, k) (3 - k - |x|)_+^5 / 120.
inline double quintic_weight(double x) {
    const auto fifth = [](double y) { return y > 0 ? y * y * y * y * y : 0.0; };
    x = std::abs(x);
    return (fifth(3.0 - x) - 6.0 * fifth(2.0 - x) + 15.0 * fifth(1.0 - x)) / 120.0;
}

/// The whole path as a function of its length: consecutive stretches.
class Track {
  public:
    explicit Track(const std::vector<Stretch> &stretches) : stretches_(stretches), starts_{0} {
        for (const Stretch &s : stretches) {
            starts_.push_back(starts_.back() + s.step * static_cast<double>(s.points.size() - 1));
        }
    }
    double length() const { return starts_.back(); }
    const std::vector<double> &starts() const { return starts_; }

    struct Place {
        Pose pose, programmed;
        double feed = 0;
        bool isExact = false;
    };
    Place at(double s) const {
        const auto k = stretch_of(s);
        const Stretch &stretch = stretches_[k];
        const double x = (s - starts_[k]) / stretch.step;
        const auto n = static_cast<long>(stretch.points.size());
        const long i = std::clamp(static_cast<long>(std::floor(x)), 0L, n - 2);
        const auto at = static_cast<std::size_t>(i);
        const double part = std::clamp(x - static_cast<double>(i), 0.0, 1.0);
        Place out;
        out.feed = stretch.feed[at + 1];
        out.isExact = stretch.isExact;
        out.programmed = stretch.programmed[at] * (1.0 - part) + stretch.programmed[at + 1] * part;
        out.pose = pose_at(stretch, i, x);
        return out;
    }

  private:
    static Pose pose_at(const Stretch &stretch, long i, double x) {
        return stretch.isExact ? cubic_at(stretch, i, x) : spline_at(stretch, i, x - static_cast<double>(i));
    }

    static Pose cubic_at(const Stretch &stretch, long i, double x) {
        const auto n = static_cast<long>(stretch.points.size());
        const long first = std::clamp(i - 1, 0L, std::max(0L, n - 4));
        const long count = std::min(4L, n);
        Pose sum;
        for (long a = first; a < first + count; ++a) {
            double w = 1;
            for (long b = first; b < first + count; ++b) {
                w *= b == a ? 1.0 : (x - static_cast<double>(b)) / static_cast<double>(a - b);
            }
            sum = sum + stretch.points[static_cast<std::size_t>(a)] * w;
        }
        return sum;
    }

    /// Quintic B-spline with the points as control points, mirrored at the ends.
    static Pose spline_at(const Stretch &stretch, long i, double u) {
        const auto n = static_cast<long>(stretch.points.size());
        Pose sum;
        for (long a = i - 2; a <= i + 3; ++a) {
            const double w = quintic_weight(u - static_cast<double>(a - i));
            const auto point = [&](long k) { return stretch.points[static_cast<std::size_t>(k)]; };
            const Pose p = a < 0    ? point(0) * 2.0 - point(std::min(-a, n - 1))
                           : a >= n ? point(n - 1) * 2.0 - point(std::max(2 * (n - 1) - a, 0L))
                                    : point(a);
            sum = sum + p * w;
        }
        return sum;
    }

    std::size_t stretch_of(double s) const {
        const auto k = std::upper_bound(starts_.begin(), starts_.end(), s) - starts_.begin() - 1;
        return static_cast<std::size_t>(std::clamp(k, 0L, static_cast<long>(stretches_.size()) - 1));
    }
    const std::vector<Stretch> &stretches_;
    std::vector<double> starts_;
};

}  // namespace mw::bench

// SPDX-License-Identifier: GPL-2.0-or-later
// Nodes along a path at equal time intervals, and their redistribution after a change of the timing.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "traj/track.hh"

namespace mw::bench {

inline constexpr int MOST_AXES = 9;
inline constexpr std::size_t PAD = 8;  ///< number of nodes without motion at each end
inline constexpr double REACH = 3;     ///< nodes on each side on which a blended value depends
inline constexpr double ROOM = 1.0 - 2e-7;
inline constexpr double TUBE = 0.95,
                        MOST = 1.02;  ///< used fraction of P, and its increase by redistribution
inline constexpr double PERIOD = 1e-3, FINE_PERIOD = 0.25e-3;

using Row = std::array<double, MOST_AXES>;

inline double square(double x) {
    return x * x;
}

/// Nodes and their b.
struct Nodes {
    std::vector<double> s;  ///< position of each node on the track
    std::vector<Row> q;     ///< the coordinates that move
    std::vector<double> b;
};

class Laying {
  public:
    Laying(const Track &track, const Program &program) : track_(track), program_(program) {
        for (int k = 0; k < geometry::AXIS_COUNT; ++k) {
            const double from = track.at(0).pose[k];
            bool isMoving = false;
            for (double s = 0; s <= track.length() && !isMoving; s += track.length() / 5000) {
                isMoving = track.at(s).pose[k] != from;
            }
            if (isMoving) {
                axis_[axes_++] = k;
            }
        }
    }

  protected:
    std::size_t count() const { return n_.s.size(); }

    /// Each stretch between stops gets a slow start and end with very smooth timing.
    void lay_slowly() {
        n_.s.assign(PAD, 0.0);
        const std::vector<double> &starts = track_.starts();
        for (std::size_t k = 0; k + 1 < starts.size(); ++k) {
            const double length = starts[k + 1] - starts[k];
            const int n = std::max(60, static_cast<int>(length / 0.02));
            const double ends = std::clamp(0.3 * n, 20.0, 200.0) / n;
            double sum = 0;
            std::vector<double> way{0};
            for (int i = 0; i < n; ++i) {
                const double u = (i + 0.5) / n;
                const double x = std::min({1.0, u / ends, (1.0 - u) / ends});
                sum += x * x * x * (10.0 - 15.0 * x + 6.0 * x * x);
                way.push_back(sum);
            }
            for (int i = 1; i <= n; ++i) {
                n_.s.push_back(starts[k] + length * way[static_cast<std::size_t>(i)] / sum);
            }
        }
        n_.s.insert(n_.s.end(), PAD, track_.length());
        laid_period_ = 1e-3;
        lay(n_, false);
        laid_period_ = 1.5e-3 * worst();
        lay(n_, false);
    }

    /// Uses nodes at equal time intervals. Their coordinates are those of the track unless they are free.
    void lay(Nodes nodes, bool isFree) {
        n_ = std::move(nodes);
        period_ = laid_period_;
        const std::size_t n = count();
        n_.b.assign(n, 1.0);
        n_.q.resize(n);
        programmed_.resize(n);
        feed_.resize(n);
        isExact_.resize(n);
        tube_.resize(n);
        for (std::size_t i = 0; i < n; ++i) {
            const Track::Place place = track_.at(n_.s[i]);
            for (std::size_t k = 0; k < axes_; ++k) {
                n_.q[i][k] = isFree && !place.isExact ? n_.q[i][k] : place.pose[axis_[k]];
                programmed_[i][k] = place.programmed[axis_[k]];
            }
            pull_in(i);
            const auto outside = off(n_, i);
            tube_[i] = std::max(1.0, 1.005 * std::max(outside[0], outside[1]));
            feed_[i] = place.feed > 0 ? 1.0 / (place.feed * period_) : 0.0;
            isExact_[i] = place.isExact;
        }
        for (std::size_t k = 0; k < axes_; ++k) {
            const int axis = axis_[k];
            v_scale_[k] = 1.0 / (program_.max_velocity[axis] * ROOM * period_);
            a_scale_[k] = 1.0 / (program_.max_acceleration[axis] * ROOM * square(period_));
            j_scale_[k] = 1.0 / (program_.max_jerk[axis] * ROOM * period_ * square(period_));
        }
        find_sides();
    }

    /// Redistribution may move some nodes slightly out of the tube.
    void pull_in(std::size_t i) {
        const auto outside = off(n_, i);
        for (std::size_t k = 0; k < axes_; ++k) {
            const double x = outside[geometry::isAngular(axis_[k]) ? 1 : 0];
            if (x > square(MOST)) {
                n_.q[i][k] = programmed_[i][k] + (n_.q[i][k] - programmed_[i][k]) * MOST / std::sqrt(x);
            }
        }
    }

    /// Directions across the path in which nodes may move.
    void find_sides() {
        side_.assign(count(), {});
        for (std::size_t i = 1; i + 1 < count(); ++i) {
            Row tangent{};
            double size = 0;
            for (std::size_t k = 0; k < axes_; ++k) {
                tangent[k] = n_.q[i + 1][k] - n_.q[i - 1][k];
                size += square(tangent[k]);
            }
            if (size < 1e-18 || isExact_[i] || isPad(i)) {
                continue;
            }
            std::vector<Row> base{tangent};
            for (std::size_t k = 0; k < axes_; ++k) {
                base[0][k] /= std::sqrt(size);
            }
            std::size_t skip = 0;  // axis with the largest component along the path
            for (std::size_t k = 1; k < axes_; ++k) {
                skip = std::abs(tangent[k]) > std::abs(tangent[skip]) ? k : skip;
            }
            for (std::size_t a = 0; a < axes_; ++a) {
                if (a == skip) {
                    continue;
                }
                Row x{};
                x[a] = 1;
                for (const Row &other : base) {
                    double dot = 0;
                    for (std::size_t k = 0; k < axes_; ++k) {
                        dot += x[k] * other[k];
                    }
                    for (std::size_t k = 0; k < axes_; ++k) {
                        x[k] -= dot * other[k];
                    }
                }
                double norm = 0;
                for (std::size_t k = 0; k < axes_; ++k) {
                    norm += square(x[k]);
                }
                for (std::size_t k = 0; k < axes_; ++k) {
                    x[k] /= std::sqrt(norm);
                    side_[i][base.size() - 1][k] = x[k] * program_.tolerance;
                }
                base.push_back(x);
            }
        }
    }

    /// Nothing moves there: b is that of the next node.
    bool isPad(std::size_t i) const { return i < PAD || i + PAD >= count(); }

    double acceleration(const Nodes &n, std::size_t i, std::size_t k) const {
        return (n.q[i + 1][k] - 2.0 * n.q[i][k] + n.q[i - 1][k]) * n.b[i] +
               0.125 * (n.q[i + 1][k] - n.q[i - 1][k]) * (n.b[i + 1] - n.b[i - 1]);
    }

    /// Factor by which the time must be stretched to be within every limit with b = 1.
    double worst() const {
        double over = 0;
        for (std::size_t i = 2; i + 2 < count(); ++i) {
            double way = 0;
            for (std::size_t k = 0; k < axes_; ++k) {
                const double step = n_.q[i][k] - n_.q[i - 1][k];
                const double a = acceleration(n_, i, k);
                way += square(step);
                over = std::max({over, std::abs(step) * v_scale_[k], std::sqrt(std::abs(a) * a_scale_[k]),
                                 std::cbrt(std::abs(a - acceleration(n_, i - 1, k)) * j_scale_[k])});
            }
            over = std::max(over, std::sqrt(way) * feed_[i]);
        }
        return over;
    }

    /// Squared distances from the programmed path divided by P squared: element 0 for lengths, element 1 for
    /// angles.
    std::array<double, 2> off(const Nodes &n, std::size_t i) const {
        std::array<double, 2> sum{};
        for (std::size_t k = 0; k < axes_; ++k) {
            sum[geometry::isAngular(axis_[k]) ? 1 : 0] += square(n.q[i][k] - programmed_[i][k]);
        }
        const double p2 = square(TUBE * program_.tolerance);
        return {sum[0] / p2, sum[1] / p2};
    }

    /// Nodes at intervals of about `period` in the time defined by b.
    Nodes even(double period) {
        const std::size_t n = count();
        std::vector<double> t(n, 0.0);
        for (std::size_t i = 1; i < n; ++i) {
            t[i] = t[i - 1] + 0.5 * period_ * (1.0 / std::sqrt(n_.b[i - 1]) + 1.0 / std::sqrt(n_.b[i]));
        }
        const auto blend_t = [&](double u) { return blended(n, u, [&](std::size_t i) { return t[i]; }); };
        const double last = static_cast<double>(n - PAD) + REACH;
        double u = PAD - 1 - REACH;
        const double begin = blend_t(u);
        time_s_ = blend_t(last) - begin;
        const auto laid = static_cast<std::size_t>(std::ceil(time_s_ / period - 1e-9));
        laid_period_ = time_s_ / static_cast<double>(laid);
        Nodes out;
        const auto push = [&](double at) {
            const double s = blended(n, at, [&](std::size_t i) { return n_.s[i]; });
            out.s.push_back(std::clamp(s, out.s.empty() ? 0.0 : out.s.back(), track_.length()));
            Row q{};
            for (std::size_t k = 0; k < axes_; ++k) {
                q[k] = blended(n, at, [&](std::size_t i) { return n_.q[i][k]; });
            }
            out.q.push_back(q);
        };
        for (std::size_t i = 1; i < PAD; ++i) {
            push(0);
        }
        for (std::size_t i = 0; i < laid; ++i) {
            const double at = begin + laid_period_ * static_cast<double>(i);
            double reach = 1;
            while (u + reach < last && blend_t(u + reach) < at) {
                reach *= 2;
            }
            double high = std::min(u + reach, last);
            for (int k = 0; k < 50 && high - u > 1e-12 * high; ++k) {
                const double middle = 0.5 * (u + high);
                (blend_t(middle) < at ? u : high) = middle;
            }
            push(u);
        }
        for (std::size_t i = 0; i < PAD; ++i) {
            push(static_cast<double>(n - 1));
        }
        return out;
    }

    /// Quintic B-spline with these values as control points; its differences are averages of their
    /// differences.
    template <class Value>
    static double blended(std::size_t n, double u, const Value &value) {
        const auto i = static_cast<long>(std::floor(u));
        double sum = 0;
        for (long a = i - 2; a <= i + 3; ++a) {
            const long k = std::clamp(a, 0L, static_cast<long>(n) - 1);
            sum += value(static_cast<std::size_t>(k)) * quintic_weight(u - static_cast<double>(a));
        }
        return sum;
    }

    /// The nodes as samples, at an interval for which every limit is kept.
    Trajectory sampled() {
        const Nodes keep = n_;
        const double period = period_;
        lay(even(PERIOD), sides_ > 0);
        Trajectory out;
        out.period_s = period_ * std::max(1.0, worst());
        out.time_s = time_s_ / period_ * out.period_s;
        for (std::size_t i = 0; i < count(); ++i) {
            Pose p = track_.at(0).pose;
            for (std::size_t k = 0; k < axes_; ++k) {
                p[axis_[k]] = n_.q[i][k];
            }
            out.samples.push_back(p);
        }
        const std::vector<double> b = keep.b;
        laid_period_ = period;
        lay(keep, sides_ > 0);
        n_.b = b;
        return out;
    }

    const Track &track_;
    const Program &program_;
    std::array<int, MOST_AXES> axis_{};
    std::size_t axes_ = 0, sides_ = 0;
    Nodes n_;
    std::vector<Row> programmed_;
    std::vector<double> feed_;  ///< reciprocal of the distance per period, 0: no limit
    std::vector<char> isExact_;
    std::vector<double> tube_;  ///< permitted squared distance, divided by that of TUBE
    std::vector<std::array<Row, MOST_AXES - 1>> side_;
    Row v_scale_{}, a_scale_{}, j_scale_{};
    double period_ = PERIOD, laid_period_ = PERIOD, time_s_ = 0;
};

}  // namespace mw::bench

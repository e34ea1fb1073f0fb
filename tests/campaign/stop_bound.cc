// SPDX-License-Identifier: GPL-2.0-or-later
#include "campaign/stop_bound.hh"

#include <algorithm>
#include <cmath>

namespace mw::campaign {
namespace {

/// Products of the first and second derivatives by the sample's number.
struct Products {
    double first2 = 0, both = 0, second2 = 0;
};

Products products_at(const StoppingGroup &group, std::size_t n) {
    Products p;
    for (const std::vector<double> &q : group.places) {
        const double first = 0.5 * (q[n + 1] - q[n - 1]);
        const double second = q[n + 1] - 2 * q[n] + q[n - 1];
        p.first2 += first * first;
        p.both += first * second;
        p.second2 += second * second;
    }
    return p;
}

/// The smallest change of the rate [1/sample^2] that all accelerations allow at a sample, at `rate` times the
/// speed of the original motion: |second rate^2 + first change| <= limit.
double hardest_brake(const std::vector<StoppingGroup> &groups, std::size_t n, double rate, double period_s) {
    constexpr double STANDING = 1e-24;
    double hardest = -1e300;
    for (const StoppingGroup &group : groups) {
        const Products p = products_at(group, n);
        if (p.first2 < STANDING) {
            continue;
        }
        const double limit = group.acceleration * period_s * period_s;
        const double rest = std::max(limit * limit, p.second2) - p.second2 * std::pow(rate, 4);
        const double along = p.both * rate * rate;
        hardest = std::max(hardest, (-along - std::sqrt(along * along + p.first2 * rest)) / p.first2);
    }
    return std::min(hardest, 0.0);
}

}  // namespace

LeastStop least_stop(const std::vector<StoppingGroup> &groups, double period_s) {
    const std::size_t count = groups.empty() ? 0 : groups.front().places.front().size();
    LeastStop stop;
    double rate = 1;
    for (std::size_t n = 2; n + 1 < count; ++n) {
        const double change = hardest_brake(groups, n, rate, period_s);
        const double next2 = rate * rate + 2 * change;
        if (next2 <= 0) {
            stop.seconds += rate / -change * period_s;
            stop.isOver = true;
            return stop;
        }
        const double next = std::sqrt(next2);
        stop.seconds += 2 / (rate + next) * period_s;
        rate = next;
    }
    return stop;
}

double least_stop_with_jerk(const std::vector<double> &places, double jerk, double period_s) {
    if (!(jerk > 0) || places.size() < 3) {
        return 0;
    }
    const double v = (places[2] - places[1]) / period_s;
    const double a = (v - (places[1] - places[0]) / period_s) / period_s;
    const double rising = v < 0 ? -a : a;  // negative: a part of the stop is done
    return rising / jerk + 2 * std::sqrt((std::abs(v) + 0.5 * rising * rising / jerk) / jerk);
}

}  // namespace mw::campaign

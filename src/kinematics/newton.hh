// SPDX-License-Identifier: GPL-2.0-or-later
// The pose of a platform on struts of given lengths, by Newton's method (Merlet, Parallel Robots, 4.4) with
// steps that do not change the assembly mode. Header-only and realtime-safe.
#pragma once

#include <algorithm>
#include <cmath>

#include "kinematics/kinematics.hh"
#include "kinematics/linear_solve.hh"

namespace mw::kinematics {

template <std::size_t N>
struct StrutLengths {
    Row<N> of{};     ///< strut lengths [machine units]
    Square<N> by{};  ///< derivatives by the N coordinates of a pose; angles are multiplied by the rim, so
                     ///< that all coordinates are lengths
};

struct NewtonTerms {
    double criterion = 0;  ///< permitted error of a strut in a solution [machine units]
    double max_error = 0;  ///< error above which the search fails [machine units]
    double limit = 0;      ///< maximum number of iterations
    double rim = 1;        ///< size of the platform, by which rotations are scaled to lengths [machine units]
};

/// `Search` contains a pose and a step from this pose. `lengths_at(share)` returns the StrutLengths<N> at
/// this fraction of the step; `go(share, step)` moves there, sets the next step and returns its length
/// [machine units]. OK or SINGULAR: the solution is at `share` of the step.
template <std::size_t N, class Search>
Status find_platform(const double *joints, const NewtonTerms &terms, Search &search, double &share,
                     int &iterations) noexcept {
    constexpr double MOST_ITERATIONS = 1000;
    constexpr double STRIDE = 0.05;  // as a fraction of the rim; a longer step may reach another solution
    constexpr double ROUNDING = 1e-6;
    const int limit = static_cast<int>(std::min(terms.limit, MOST_ITERATIONS));
    double before = 1e300;
    int side_at_start = 0;
    share = 1;
    for (iterations = 0; iterations < limit; ++iterations) {
        const StrutLengths<N> lengths = search.lengths_at(share);
        Row<N> step{};
        double miss = 0;
        for (std::size_t i = 0; i < N; ++i) {
            step[i] = joints[i] - lengths.of[i];
            miss = std::max(miss, std::abs(step[i]));
        }
        int side_here = 0;
        const double pivot = solve(lengths.by, step, side_here);
        side_at_start = iterations == 0 ? side_here : side_at_start;
        const bool is_same_side = side_here == side_at_start || pivot <= SINGULAR_PIVOT;
        // One more step than required removes the remaining error, except for rounding.
        const bool settled =
            miss < terms.criterion && (miss < ROUNDING * terms.criterion || miss >= 0.5 * before);
        if (settled && is_same_side) {
            return pivot > SINGULAR_PIVOT ? Status::OK : Status::SINGULAR;
        }
        if (!(miss <= terms.max_error) || !(pivot > 0)) {
            return Status::UNREACHABLE;
        }
        if (!is_same_side || miss > before) {
            share *= 0.5;  // the step was too long
            continue;
        }
        share = std::min(1.0, STRIDE * terms.rim / std::max(search.go(share, step), 1e-300));
        before = miss;
    }
    return Status::UNREACHABLE;
}

}  // namespace mw::kinematics

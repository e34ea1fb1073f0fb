// SPDX-License-Identifier: GPL-2.0-or-later
// The pose of a platform on struts of given lengths, by Newton's method (Merlet, Parallel Robots, 4.4) in
// strides that do not lead to another way to put the struts together. Header-only and realtime-safe.
#pragma once

#include <algorithm>
#include <cmath>

#include "kinematics/kinematics.hh"
#include "kinematics/linear_solve.hh"

namespace mw::kinematics {

template <std::size_t N>
struct StrutLengths {
    Row<N> of{};     ///< [machine units]
    Square<N> by{};  ///< by the N numbers of a pose; angles times the rim, so that all are lengths
};

struct NewtonTerms {
    double criterion = 0;  ///< what may be wrong with a strut in a solution [machine units]
    double max_error = 0;  ///< beyond it the search has failed [machine units]
    double limit = 0;      ///< of the iterations
    double rim = 1;        ///< size of the platform, which turns are measured by [machine units]
};

/// `Search` stands at a pose and has a way from there: `lengths_at(share)` gives the StrutLengths<N> so much
/// of the way ahead, `go(share, step)` stands there and takes `step` as its next way, whose length it gives
/// [machine units]. OK or SINGULAR: the solution is `share` of the way ahead.
template <std::size_t N, class Search>
Status find_platform(const double *joints, const NewtonTerms &terms, Search &search, double &share,
                     int &iterations) noexcept {
    constexpr double MOST_ITERATIONS = 1000;
    constexpr double STRIDE = 0.05;  // of the rim; a longer one may lead to another way
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
        const bool isSameSide = side_here == side_at_start || pivot <= SINGULAR_PIVOT;
        // One step beyond what is asked for takes the rest of the error, where rounding leaves anything to
        // take.
        const bool isSettled =
            miss < terms.criterion && (miss < ROUNDING * terms.criterion || miss >= 0.5 * before);
        if (isSettled && isSameSide) {
            return pivot > SINGULAR_PIVOT ? Status::OK : Status::SINGULAR;
        }
        if (!(miss <= terms.max_error) || !(pivot > 0)) {
            return Status::UNREACHABLE;
        }
        if (!isSameSide || miss > before) {
            share *= 0.5;  // too far
            continue;
        }
        share = std::min(1.0, STRIDE * terms.rim / std::max(search.go(share, step), 1e-300));
        before = miss;
    }
    return Status::UNREACHABLE;
}

}  // namespace mw::kinematics

// SPDX-License-Identifier: GPL-2.0-or-later
#include "trajectory/curve/spline.hh"

#include <algorithm>

namespace mw::trajectory::curve {

double KnotRow::at(long k) const noexcept {
    return knots_[static_cast<std::size_t>(std::clamp(k, 0L, static_cast<long>(knots_.size()) - 1))];
}

double KnotRow::greville(std::size_t i) const noexcept {
    double sum = 0;
    for (long k = 0; k < DEGREE; ++k) {
        sum += at(static_cast<long>(i) - DEGREE + 1 + k);
    }
    return sum / DEGREE;
}

double KnotRow::curvature_shift(std::size_t i) const noexcept {
    const double centre = greville(i);
    double squares = 0;
    for (long k = 0; k < DEGREE; ++k) {
        const double d = at(static_cast<long>(i) - DEGREE + 1 + k) - centre;
        squares += d * d;
    }
    // The deviations add up to 0, so the sum of the products of pairs is minus half of the sum of squares.
    return -0.5 * squares / (DEGREE * (DEGREE - 1) / 2);
}

void KnotRow::weights(std::size_t span, Weights &w) const noexcept {
    const auto k = static_cast<long>(span);
    const double from = at(k);
    const double h = at(k + 1) - from;
    // basis[j]: the basis function of degree p whose support begins at knot k - p + j, as a polynomial in u.
    std::array<std::array<double, COEFFICIENTS>, COEFFICIENTS> basis{}, next{};
    basis[0][0] = 1;
    for (long p = 1; p <= DEGREE; ++p) {
        for (auto &row : next) {
            row.fill(0);
        }
        for (long j = 0; j < p; ++j) {
            // The basis function basis[j] of degree p - 1 is nonzero from knot `left` to knot `right`.
            const double left = at(k - p + 1 + j);
            const double right = at(k + 1 + j);
            const double per = 1.0 / (right - left);
            const double rise0 = (from - left) * per;
            const double fall0 = (right - from) * per;
            const double slope = h * per;
            const auto &f = basis[static_cast<std::size_t>(j)];
            auto &low = next[static_cast<std::size_t>(j)];
            auto &high = next[static_cast<std::size_t>(j + 1)];
            for (std::size_t n = 0; n < static_cast<std::size_t>(p); ++n) {
                low[n] += fall0 * f[n];
                low[n + 1] -= slope * f[n];
                high[n] += rise0 * f[n];
                high[n + 1] += slope * f[n];
            }
        }
        basis = next;
    }
    for (std::size_t n = 0; n < COEFFICIENTS; ++n) {
        for (std::size_t j = 0; j < COEFFICIENTS; ++j) {
            w[n][j] = basis[j][n];
        }
    }
}

}  // namespace mw::trajectory::curve

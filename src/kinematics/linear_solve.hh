// SPDX-License-Identifier: GPL-2.0-or-later
// Small systems of linear equations, for models that iterate. Header-only and realtime-safe.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

namespace mw::kinematics {

template <std::size_t N>
using Row = std::array<double, N>;
template <std::size_t N>
using Square = std::array<Row<N>, N>;

/// Replaces `right` by the solution x of m x = right; `turn` is the sign of the determinant. Returns the
/// smallest pivot divided by the largest, a measure of the distance from a singular matrix; 0, with `turn` 0
/// and no solution, if there is none. Gaussian elimination with complete pivoting.
template <std::size_t N>
double solve(Square<N> m, Row<N> &right, int &turn) noexcept {
    std::array<std::size_t, N> column{};
    double largest = 0;
    double smallest = 0;
    int sign = 1;
    turn = 0;
    for (std::size_t i = 0; i < N; ++i) {
        column[i] = i;
    }
    for (std::size_t step = 0; step < N; ++step) {
        std::size_t row_at = step;
        std::size_t column_at = step;
        for (std::size_t r = step; r < N; ++r) {
            for (std::size_t c = step; c < N; ++c) {
                const bool larger = std::abs(m[r][c]) > std::abs(m[row_at][column_at]);
                row_at = larger ? r : row_at;
                column_at = larger ? c : column_at;
            }
        }
        std::swap(m[step], m[row_at]);
        std::swap(right[step], right[row_at]);
        for (Row<N> &row : m) {
            std::swap(row[step], row[column_at]);
        }
        std::swap(column[step], column[column_at]);
        const double pivot = m[step][step];
        sign = (pivot < 0) != ((row_at == step) != (column_at == step)) ? -sign : sign;
        largest = step == 0 ? std::abs(pivot) : largest;
        smallest = std::abs(pivot);
        if (!(smallest > 0) || !std::isfinite(smallest)) {
            return 0;
        }
        for (std::size_t r = step + 1; r < N; ++r) {
            const double k = m[r][step] / pivot;
            for (std::size_t c = step; c < N; ++c) {
                m[r][c] -= k * m[step][c];
            }
            right[r] -= k * right[step];
        }
    }
    Row<N> solution{};
    for (std::size_t i = N; i-- > 0;) {
        double sum = right[i];
        for (std::size_t c = i + 1; c < N; ++c) {
            sum -= m[i][c] * solution[column[c]];
        }
        solution[column[i]] = sum / m[i][i];
    }
    right = solution;
    turn = sign;
    return smallest / largest;
}

template <std::size_t N>
double solve(const Square<N> &m, Row<N> &right) noexcept {
    int turn = 0;
    return solve(m, right, turn);
}

/// Result of `solve` below which a pose is singular.
inline constexpr double SINGULAR_PIVOT = 1e-7;

}  // namespace mw::kinematics

// SPDX-License-Identifier: GPL-2.0-or-later
// Speed and path acceleration of a stretch of path such that every axis keeps its limits. Planning side,
// pure. Formulas: docs/developer/third_order.md.
#pragma once

#include <algorithm>
#include <cmath>

#include "trajectory/path/primitive.hh"

namespace mw::trajectory {

/// Limits of the axes, joints already folded in; UNLIMITED where nothing limits.
struct Limits {
    PerLimited velocity{};      ///< [unit/s]; the last is the XYZ norm
    PerLimited acceleration{};  ///< [unit/s^2]
    PerLimited jerk{};          ///< [unit/s^3]; used when `isJerkLimited`
    bool isJerkLimited = false;
};
inline constexpr double UNLIMITED = 1e300;

/// Path acceleration that limits allow, by the squared speed b: the least of some lines alpha - beta b.
struct AccelBound {
    static constexpr int LINES = 3;
    std::array<double, LINES> alpha{}, beta{};

    static AccelBound constant(double a) noexcept {
        AccelBound bound;
        bound.alpha.fill(a);
        return bound;
    }
    /// Through what is left at some parts of the squared speed v^2.
    static AccelBound through(const double (&left)[LINES + 1], double v) noexcept;
    /// At the squared speed b, never negative.
    double at(double b) const noexcept {
        double a = alpha[0] - beta[0] * b;
        for (std::size_t k = 1; k < LINES; ++k) {
            const double c = alpha[k] - beta[k] * b;
            a = c < a ? c : a;
        }
        return a > 0 ? a : 0;
    }
};

/// v: maximum speed along the parameter; a: path acceleration that may be used, by the speed squared.
struct SpeedLimit {
    double v = 0;
    AccelBound a;
};

/// Largest derivatives by the path's parameter of one limited coordinate on a stretch, and its limits.
struct LimitRow {
    double q1 = 0, q2 = 0;
    double velocity = UNLIMITED, acceleration = UNLIMITED;
    bool isRightAngled = false;  ///< q1 and q2 are lengths of vectors at right angles
};

/// Largest |dq/ds| and |d2q/ds2| per coordinate on the part [from, to] of a primitive; the last of each are
/// those of the XYZ norm.
void derivative_bounds(const Primitive &p, double from, double to, PerLimited &q1, PerLimited &q2) noexcept;

/// Speeds and accelerations for which q1 v <= velocity and q1 |a| + q2 v^2 <= acceleration in every row, up
/// to the requested speed `wish`.
SpeedLimit limit_of_rows(const LimitRow *rows, int count, double wish) noexcept;

/// The same on the part [from, to] of a primitive.
SpeedLimit limit_of(const Primitive &p, double from, double to, const Limits &limits, double wish) noexcept;

}  // namespace mw::trajectory

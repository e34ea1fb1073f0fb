// SPDX-License-Identifier: GPL-2.0-or-later
// Speed and path acceleration of a part of the path within the limits of every axis. For the planner; pure
// functions. Formulas: docs/developer/third_order.md.
#pragma once

#include <algorithm>
#include <cmath>

#include "trajectory/path/primitive.hh"

namespace mw::trajectory {

/// Limits of the axes, including those of the joints; UNLIMITED: no limit.
struct Limits {
    PerLimited velocity{};      ///< [unit/s]; the last element is for the XYZ norm
    PerLimited acceleration{};  ///< [unit/s^2]
    PerLimited jerk{};          ///< [unit/s^3]; valid if `isJerkLimited`
    bool isJerkLimited = false;
};
inline constexpr double UNLIMITED = 1e300;

/// Maximum path acceleration as a function of the squared speed b: the minimum of the lines alpha - beta b.
struct AccelBound {
    static constexpr int LINES = 3;
    std::array<double, LINES> alpha{}, beta{};

    static AccelBound constant(double a) noexcept {
        AccelBound bound;
        bound.alpha.fill(a);
        return bound;
    }
    /// Lines through the values `left`, which belong to fixed fractions of the squared speed v^2.
    static AccelBound through(const double (&left)[LINES + 1], double v) noexcept;
    /// Maximum path acceleration at the squared speed b; never negative.
    double at(double b) const noexcept {
        double a = alpha[0] - beta[0] * b;
        for (std::size_t k = 1; k < LINES; ++k) {
            const double c = alpha[k] - beta[k] * b;
            a = c < a ? c : a;
        }
        return a > 0 ? a : 0;
    }
};

/// v: maximum speed along the parameter [1/s]; a: maximum path acceleration by the squared speed [1/s^2].
struct SpeedLimit {
    double v = 0;
    AccelBound a;
};

/// Limits of one coordinate, and the maximum of its derivatives by the path parameter on a part of the path.
struct LimitRow {
    double q1 = 0, q2 = 0;
    double velocity = UNLIMITED, acceleration = UNLIMITED;
    bool isRightAngled = false;  ///< q1 and q2 are the lengths of perpendicular vectors
};

/// Calculates the maximum |dq/ds| and |d2q/ds2| of each coordinate on the part [from, to] of a primitive. The
/// last elements are for the XYZ norm.
void derivative_bounds(const Primitive &p, double from, double to, PerLimited &q1, PerLimited &q2) noexcept;

/// Maximum speed, up to the requested speed `wish`, and path acceleration for which every row has q1 v <=
/// velocity and q1 |a| + q2 v^2 <= acceleration.
SpeedLimit limit_of_rows(const LimitRow *rows, int count, double wish) noexcept;

/// The same for the part [from, to] of a primitive.
SpeedLimit limit_of(const Primitive &p, double from, double to, const Limits &limits, double wish) noexcept;

}  // namespace mw::trajectory

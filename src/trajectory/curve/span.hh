// SPDX-License-Identifier: GPL-2.0-or-later
// A part of a curve in nine coordinates, and a cell of the motion along it. The executor evaluates both.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "base/geometry/pose.hh"

namespace mw::trajectory::curve {

using geometry::Pose;

inline constexpr int DEGREE = 5;
inline constexpr std::size_t COEFFICIENTS = DEGREE + 1;

/// Two values of s that differ by at most this count as equal, for planner and executor [unit].
inline constexpr double SAME_PLACE = 1e-9;

/// The curve between two knots: q(s) is the sum of c[k] u^k, u = (s - start_s)/length in [0, 1].
struct Span {
    static constexpr std::uint32_t ALL = (1U << geometry::AXIS_COUNT) - 1U;
    double start_s = 0, length = 0;
    std::array<Pose, COEFFICIENTS> c{};
    std::uint32_t moving = ALL;  ///< one bit per coordinate that moves; the others are constant
    double end_s() const noexcept { return start_s + length; }
    /// Sets `moving` from the coefficients.
    void find_moving() noexcept;
};

/// A point of the curve and its derivatives by s.
struct CurvePoint {
    Pose position, first, second, third;
};

/// Position at `s` of a span. [servo, planner]
Pose position_at(const Span &span, double s) noexcept;
/// Position and derivatives at `s` of a span. [planner]
CurvePoint point_at(const Span &span, double s) noexcept;

/// Path position by time: s(t) is a polynomial of degree five, t in [0, duration] [s].
struct TimeCell {
    double duration = 0;
    std::array<double, COEFFICIENTS> c{};
    double s_at(double t) const noexcept {
        return c[0] + t * (c[1] + t * (c[2] + t * (c[3] + t * (c[4] + t * c[5]))));
    }
    double v_at(double t) const noexcept {
        return c[1] + t * (2 * c[2] + t * (3 * c[3] + t * (4 * c[4] + t * 5 * c[5])));
    }
};

}  // namespace mw::trajectory::curve

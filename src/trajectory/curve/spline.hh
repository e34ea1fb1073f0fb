// SPDX-License-Identifier: GPL-2.0-or-later
// A quintic spline in nine coordinates by the length of the programmed path. Continuous up to its fourth
// derivative.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "base/geometry/pose.hh"

namespace mw::trajectory::curve {

using geometry::Pose;

inline constexpr int DEGREE = 5;
inline constexpr std::size_t COEFFICIENTS = DEGREE + 1;

/// A stretch between two knots: q(s) is the sum of c[k] u^k, u = (s - start_s)/length in [0, 1].
struct Span {
    double start_s = 0, length = 0;
    std::array<Pose, COEFFICIENTS> c{};
    double end_s() const noexcept { return start_s + length; }
};

/// A point of the curve and its derivatives by s.
struct CurvePoint {
    Pose position, first, second, third;
};

/// [servo, planner] Position at `s` of a span.
Pose position_at(const Span &span, double s) noexcept;
/// [planner] Position and derivatives at `s` of a span.
CurvePoint point_at(const Span &span, double s) noexcept;

/// Knots of a run from stop to stop: the first and the last one count DEGREE + 1 times.
/// Control point i belongs to the place `greville(i)`: a straight line is reproduced with s as its length.
class KnotRow {
  public:
    explicit KnotRow(const std::vector<double> &knots) noexcept : knots_(knots) {}
    std::size_t spans() const noexcept { return knots_.size() - 1; }
    std::size_t controls() const noexcept { return spans() + DEGREE; }
    /// Knot `k`, clamped to the ends.
    double at(long k) const noexcept;
    /// Mean of the knots that control point `i` depends on.
    double greville(std::size_t i) const noexcept;
    /// Control value of (s - greville)^2: the control point of a curve with second derivative q'' is moved by
    /// half of this times q'', which reproduces parabolas exactly.
    double curvature_shift(std::size_t i) const noexcept;
    /// Weights of the control points span .. span + DEGREE for the coefficients of the span:
    /// [coefficient][control].
    using Weights = std::array<std::array<double, COEFFICIENTS>, COEFFICIENTS>;
    void weights(std::size_t span, Weights &w) const noexcept;

  private:
    const std::vector<double> &knots_;
};

}  // namespace mw::trajectory::curve

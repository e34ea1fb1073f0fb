// SPDX-License-Identifier: GPL-2.0-or-later
// A quintic spline in nine coordinates by the length of the programmed path. Continuous up to its fourth
// derivative.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "trajectory/curve/span.hh"

namespace mw::trajectory::curve {

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

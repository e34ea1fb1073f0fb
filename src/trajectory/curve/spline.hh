// SPDX-License-Identifier: GPL-2.0-or-later
// A quintic spline in nine coordinates by the length of the programmed path. It is continuous up to the
// fourth derivative.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "trajectory/curve/span.hh"

namespace mw::trajectory::curve {

/// Knots between two stops. The first and the last knot have the multiplicity DEGREE + 1. Control point i
/// belongs to the parameter `greville(i)`, so a straight line is reproduced with s as its length.
class KnotRow {
  public:
    explicit KnotRow(const std::vector<double> &knots) noexcept : knots_(knots) {}
    std::size_t spans() const noexcept { return knots_.size() - 1; }
    std::size_t controls() const noexcept { return spans() + DEGREE; }
    /// Knot `k`. `k` is clamped to the ends.
    double at(long k) const noexcept;
    /// Average of the knots that control point `i` depends on.
    double greville(std::size_t i) const noexcept;
    /// Control value of the function (s - greville)^2. A control point of a curve with second derivative q''
    /// is shifted by half of this times q'', so parabolas are reproduced exactly.
    double curvature_shift(std::size_t i) const noexcept;
    /// Weights of the control points span .. span + DEGREE in the coefficients of the span:
    /// [coefficient][control].
    using Weights = std::array<std::array<double, COEFFICIENTS>, COEFFICIENTS>;
    void weights(std::size_t span, Weights &w) const noexcept;

  private:
    const std::vector<double> &knots_;
};

}  // namespace mw::trajectory::curve

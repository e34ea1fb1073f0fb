// SPDX-License-Identifier: GPL-2.0-or-later
// The shortest time along a path within velocity, acceleration and jerk of every coordinate: an
// interior-point method.
//
// p is the parameter of the path, b(p) = (dp/dt)^2 the unknown: a quadratic spline. With a = b'/2 and w =
// b''/2 every limit is a row in (b, a, w):
//   q'^2 b <= V^2,  |q' a + q'' b| <= A,  |q' w + 3 q'' a + q''' b| <= J/sqrt(b).
// 1/sqrt(b) is convex, so its tangent is a safe bound: each step of Newton's method keeps every row, and the
// result of each step can be driven.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "trajectory/profile/rows.hh"

namespace mw::trajectory::profile {

/// What is made least: the time, or the speed everywhere, by the sum of the coefficients over their
/// floors, or over those of a reference.
enum class Objective : std::uint8_t { TIME, SPEED };

struct SolveSettings {
    Objective objective = Objective::TIME;
    double cell_s = 1e-3;  ///< time that counts as 1 in the objective
    double first_mu = 1, last_mu = 1e-3, factor = 0.2;
    int steps_per_mu = 20;
    const double *reference = nullptr;  ///< of the speed, cells() + 2; null: the coefficients of the start
};

class TimeLaw {
  public:
    /// Rows of the problem; they stay valid.
    /// `before`, `behind`: lengths of the cells beside them.
    void begin(const Rows &rows, double before, double behind);
    std::size_t cells() const noexcept { return rows_->cells(); }
    /// One more and one less than the cells have ends.
    std::vector<double> &coefficients() noexcept { return c_; }
    /// Least values of the coefficients; `begin` sets 0. The present coefficients are above them.
    std::vector<double> &floors() noexcept { return floors_; }
    /// From the present coefficients, which keep every row. The first `fixed_start` and the last `fixed_end`
    /// of them stay. Returns the steps of Newton's method.
    int solve(std::size_t fixed_start, std::size_t fixed_end, const SolveSettings &settings);

    /// At the part x in [0, 1] of a cell.
    LawState state(std::size_t cell, double x) const noexcept;
    /// Time of a cell [s].
    double time_of(std::size_t cell) const noexcept;
    double time() const noexcept;
    /// The largest row over its limit; above 1 one is not kept.
    double worst() const noexcept;
    /// The largest row at a place; over its limit.
    double worst_at(std::size_t cell, std::size_t place) const noexcept;

  private:
    /// Coefficients that change, and the blocks of cells in which they have part.
    struct Range {
        std::size_t first = 0, last = 0, first_block = 0, last_block = 0;
    };
    double newton(double mu, const Range &range);
    void assemble(double mu, const Range &range);
    void factorise(const Range &range);
    double longest_step(const Range &range) const;

    const Rows *rows_ = nullptr;
    std::vector<double> c_, step_, gradient_, floors_;
    std::vector<double> weights_;  ///< of the coefficients in the objective
    Lanes time_weight_{};          ///< of the time
    /// Slacks of jerk grow without bound as b falls: -log(b) for each makes their barrier that of the jerk
    /// times sqrt(b), which stays where it is for b near 0. Counts when the speed is made least.
    Lanes level_{};
    std::vector<double> h_, alpha_;  ///< padded: lengths of the cells; 1/(h of a cell + h of the one before)
    std::array<std::vector<double>, 3> diagonal_;  ///< of the Hessian: on the diagonal, one and two beside it
    double decrement_ = 0;
};

}  // namespace mw::trajectory::profile

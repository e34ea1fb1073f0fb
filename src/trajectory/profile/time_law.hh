// SPDX-License-Identifier: GPL-2.0-or-later
// The shortest time along a path within velocity, acceleration and jerk of every coordinate, by an
// interior-point method.
//
// p is the parameter of the path. The unknown is b(p) = (dp/dt)^2, a quadratic spline.
// With a = b'/2 and w = b''/2, every limit is a row in (b, a, w):
//   q'^2 b <= V^2,  |q' a + q'' b| <= A,  |q' w + 3 q'' a + q''' b| <= J/sqrt(b).
// 1/sqrt(b) is convex, so its tangent is a safe bound. Each Newton step keeps every row, so the result of
// each step is a valid motion.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "trajectory/profile/rows.hh"

namespace mw::trajectory::profile {

/// What the solver minimises: the time, or the speed everywhere. For the speed, the objective is the sum of
/// the coefficients divided by their floors or by those of a reference.
enum class Objective : std::uint8_t { TIME, SPEED };

struct SolveSettings {
    Objective objective = Objective::TIME;
    double cell_s = 1e-3;  ///< unit of time in the objective [s]
    double first_mu = 1, last_mu = 1e-3, factor = 0.2;
    int steps_per_mu = 20;
    /// Reference for the speed, cells() + 2 elements; null: the coefficients of the start.
    const double *reference = nullptr;
};

class TimeLaw {
  public:
    /// Sets the rows of the problem, which must remain valid. `before`, `behind`: lengths of the adjacent
    /// cells.
    void begin(const Rows &rows, double before, double behind);
    std::size_t cells() const noexcept { return rows_->cells(); }
    /// The coefficients, cells() + 2.
    std::vector<double> &coefficients() noexcept { return c_; }
    /// Lower bounds of the coefficients; `begin` sets 0. The current coefficients must exceed them.
    std::vector<double> &floors() noexcept { return floors_; }
    /// Solves the problem from the current coefficients, which must be within every row. The first
    /// `fixed_start` and the last `fixed_end` coefficients do not change. Returns the number of Newton steps.
    int solve(std::size_t fixed_start, std::size_t fixed_end, const SolveSettings &settings);

    /// State at the fraction x in [0, 1] of a cell.
    LawState state(std::size_t cell, double x) const noexcept;
    /// Time of a cell [s].
    double time_of(std::size_t cell) const noexcept;
    double time() const noexcept;
    /// Maximum row, divided by its limit; above 1 a limit is exceeded.
    double worst() const noexcept;
    /// Maximum row at a point, divided by its limit.
    double worst_at(std::size_t cell, std::size_t place) const noexcept;

  private:
    /// Coefficients that change, and the blocks of cells that they affect.
    struct Range {
        std::size_t first = 0, last = 0, first_block = 0, last_block = 0;
    };
    double newton(double mu, const Range &range);
    void assemble(double mu, const Range &range);
    void factorise(const Range &range);
    double longest_step(const Range &range) const;

    const Rows *rows_ = nullptr;
    std::vector<double> c_, step_, gradient_, floors_;
    std::vector<double> weights_;  ///< weights of the coefficients in the objective
    Lanes time_weight_{};          ///< weight of the time
    /// The slacks of the jerk rows grow without bound as b falls. A term -log(b) for each row makes its
    /// barrier that of the jerk times sqrt(b), which is finite for b near 0. Only for the objective SPEED.
    Lanes level_{};
    /// Padded: lengths of the cells; 1/(h of a cell + h of the previous one).
    std::vector<double> h_, alpha_;
    std::array<std::vector<double>, 3> diagonal_;  ///< diagonals of the Hessian: main, first and second
    double decrement_ = 0;
};

}  // namespace mw::trajectory::profile

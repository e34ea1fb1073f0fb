// SPDX-License-Identifier: GPL-2.0-or-later
#include "trajectory/profile/profile.hh"

#include <algorithm>
#include <cmath>

namespace mw::trajectory::profile {

namespace {

/// Cells in the time in which the jerk limit builds up an acceleration, and the least length of one [s].
constexpr double CELLS_PER_RAMP = 20;
constexpr double LEAST_CELL_S = 5e-4;
/// Parts of the limits that are planned with: a limit is kept at three places of a cell, and nearly so
/// between them.
constexpr double VELOCITY_SHARE = 0.9995, ACCELERATION_SHARE = 0.998, JERK_SHARE = 0.99;
/// The least time of a full acceleration [s]: of axes without a jerk limit, too.
constexpr double LEAST_RAMP_S = 2e-3;
/// Largest part of the path over which a start or a stop is blended.
constexpr double MAX_RAMP = 0.3;

struct Motion {
    double s = 0, v = 0, a = 0;
};

TimeCell cell_of(const Motion &from, const Motion &to, double duration) noexcept {
    const double t = duration;
    const double ds = to.s - from.s - t * (from.v + 0.5 * t * from.a);
    const double dv = (to.v - from.v - t * from.a) * t;
    const double da = (to.a - from.a) * t * t;
    const double t3 = t * t * t;
    return {duration,
            {from.s, from.v, 0.5 * from.a, (10 * ds - 4 * dv + 0.5 * da) / t3,
             (-15 * ds + 7 * dv - da) / (t3 * t), (6 * ds - 3 * dv + 0.5 * da) / (t3 * t * t)}};
}

}  // namespace

void Profile::begin(double s) noexcept {
    map_ = RestMap();
    knots_.clear();
    c_.clear();
    time_cells_.clear();
    start_s_ = s;
    before_ = 0;
    has_end_ = false;
    end_s_ = 0;
    worst_start_ = 0;
    steps_ = 0;
}

double Profile::planned_s() const noexcept {
    return knots_.empty() ? start_s_ : map_.at(knots_.back()).s;
}

void Profile::take_limits(const Run &run) {
    run_ = run;
    double ramp_s = 1e300;
    const auto share = [&](Bounds &b) {
        b.velocity *= VELOCITY_SHARE;
        b.acceleration *= ACCELERATION_SHARE;
        b.jerk = std::min(b.jerk * JERK_SHARE, b.acceleration / LEAST_RAMP_S);
        ramp_s = std::min(ramp_s, b.acceleration / b.jerk);
    };
    std::for_each(run_.limits.axes.begin(), run_.limits.axes.end(), share);
    share(run_.limits.xyz);
    cell_s_ = std::clamp(ramp_s / CELLS_PER_RAMP, LEAST_CELL_S, settings_.cell_s);
}

void Profile::lay_cells(std::size_t fixed) {
    const Run &run = run_;
    const double planned = cell_s_ * static_cast<double>(cells() - fixed);
    if (has_end_ || planned >= settings_.window_s) {
        return;
    }
    const bool is_first = knots_.empty();
    const double from = planned_s();
    const auto &laid = rough_.lay(run, {from, is_first, settings_.window_s - planned, cell_s_});
    if (laid.empty()) {
        return;
    }
    if (is_first) {
        map_.set_start(start_s_,
                       std::min(RoughProfile::ramp_at(run, start_s_), MAX_RAMP * (run.end_s - start_s_)));
        knots_.push_back(0);
    }
    // The creep that was laid before counts on the ramp before the end as long as the curve ends there.
    if (run.end_s != end_s_) {
        end_s_ = run.end_s;
        end_ramp_ = std::min(RoughProfile::ramp_at(run, run.end_s), MAX_RAMP * (run.end_s - from));
    }
    const double ramp = end_ramp_;
    const bool is_end = run.has_stop && laid.back() >= run.end_s;
    if (is_end) {
        map_.set_end(run.end_s, ramp);
        has_end_ = true;
    }
    for (const double s : laid) {
        // A stop at the end of what is known must still be possible.
        if (!is_end && s > run.end_s - ramp) {
            break;
        }
        knots_.push_back(is_end && s == laid.back() ? map_.end() : map_.parameter_at(s));
    }
    creep(run, map_, knots_, ramp, c_, creep_scale_);
}

void Profile::plan(const Run &run, std::size_t fixed) {
    take_limits(run);
    lay_cells(fixed);
    const std::size_t n = cells() - fixed;
    if (n == 0) {
        return;
    }
    const double *knots = &knots_[fixed];
    make_rows(run_, map_, knots, n, rows_);
    const double before = fixed > 0 ? knots[0] - knots[-1] : before_ > 0 ? before_ : knots[1] - knots[0];
    law_.begin(rows_, before, knots[n] - knots[n - 1]);
    const auto c = c_.begin() + static_cast<long>(fixed);
    std::copy(c, c_.end(), law_.coefficients().begin());
    worst_start_ = std::max(worst_start_, law_.worst());
    SolveSettings settings;
    settings.cell_s = cell_s_;
    const bool is_moving = fixed > 0 || before_ > 0;
    steps_ += law_.solve(is_moving ? 2 : 0, has_end_ ? 0 : 2, settings);
    std::copy_n(law_.coefficients().begin(), n + 2, c);
    make_time_cells(fixed);
}

void Profile::make_time_cells(std::size_t fixed) {
    time_cells_.resize(cells());
    const auto motion_at = [&](std::size_t cell, double x) {
        const LawState state = law_.state(cell - fixed, x);
        const MapPoint m = map_.at(knots_[cell] + x * (knots_[cell + 1] - knots_[cell]));
        return Motion{m.s, m.first * std::sqrt(state.b), m.second * state.b + m.first * state.a};
    };
    for (std::size_t k = fixed; k < cells(); ++k) {
        time_cells_[k] = cell_of(motion_at(k, 0), motion_at(k, 1), law_.time_of(k - fixed));
    }
}

void Profile::drop(std::size_t count) {
    if (count == 0) {
        return;
    }
    before_ = knots_[count] - knots_[count - 1];
    const auto n = static_cast<long>(count);
    knots_.erase(knots_.begin(), knots_.begin() + n);
    c_.erase(c_.begin(), c_.begin() + n);
    time_cells_.erase(time_cells_.begin(), time_cells_.begin() + n);
}

}  // namespace mw::trajectory::profile

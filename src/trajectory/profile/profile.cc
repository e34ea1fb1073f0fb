// SPDX-License-Identifier: GPL-2.0-or-later
#include "trajectory/profile/profile.hh"

#include <algorithm>
#include <cmath>

namespace mw::trajectory::profile {

namespace {

/// Cells that a window needs behind what is passed on.
constexpr std::size_t LEAST_CELLS = 8;
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

void Profile::begin() noexcept {
    map_ = RestMap();
    knots_.clear();
    c_.clear();
    before_ = 0;
    has_end_ = false;
    end_s_ = 0;
    is_done_ = false;
    worst_start_ = 0;
    steps_ = 0;
}

double Profile::planned_s() const noexcept {
    return knots_.empty() ? 0.0 : map_.at(knots_.back()).s;
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

void Profile::lay_cells(bool complete) {
    const Run &run = run_;
    const double length = run.spans->back().end_s();
    const double planned = cell_s_ * static_cast<double>(cells());
    if (has_end_ || planned >= settings_.window_s) {
        return;
    }
    const bool is_first = knots_.empty();
    const double from = planned_s();
    const auto &laid = rough_.lay(run, {from, is_first, complete, settings_.window_s - planned, cell_s_});
    if (laid.empty()) {
        return;
    }
    if (is_first) {
        map_.set_start(std::min(RoughProfile::ramp_at(run, 0), MAX_RAMP * length));
        knots_.push_back(0);
    }
    // The creep that was laid before counts on the ramp before the end as long as the curve ends there.
    if (length != end_s_) {
        end_s_ = length;
        end_ramp_ = std::min(RoughProfile::ramp_at(run, length), MAX_RAMP * (length - from));
    }
    const double ramp = end_ramp_;
    const bool is_end = complete && laid.back() >= length;
    if (is_end) {
        map_.set_end(length, ramp);
        has_end_ = true;
    }
    for (const double s : laid) {
        // A stop at the end of what is known must still be possible.
        if (!is_end && s > length - ramp) {
            break;
        }
        knots_.push_back(is_end && s == laid.back() ? map_.end() : map_.parameter_at(s));
    }
    creep(run, map_, knots_, ramp, c_);
}

void Profile::plan(const Run &run, bool complete) {
    take_limits(run);
    lay_cells(complete);
    const std::size_t n = cells();
    if (n == 0) {
        return;
    }
    make_rows(run_, map_, knots_.data(), n, rows_);
    law_.begin(rows_, before_ > 0 ? before_ : knots_[1] - knots_[0], knots_[n] - knots_[n - 1]);
    std::copy(c_.begin(), c_.end(), law_.coefficients().begin());
    worst_start_ = std::max(worst_start_, law_.worst());
    SolveSettings settings;
    settings.cell_s = cell_s_;
    steps_ += law_.solve(before_ > 0 ? 2 : 0, has_end_ ? 0 : 2, settings);
    std::copy_n(law_.coefficients().begin(), c_.size(), c_.begin());
}

void Profile::commit(double seconds, std::vector<TimeCell> &out) {
    double t = 0;
    std::size_t k = 0;
    const auto motion_at = [&](std::size_t cell, double x) {
        const LawState state = law_.state(cell, x);
        const MapPoint m = map_.at(knots_[cell] + x * (knots_[cell + 1] - knots_[cell]));
        return Motion{m.s, m.first * std::sqrt(state.b), m.second * state.b + m.first * state.a};
    };
    const std::size_t last = has_end_ ? cells() : cells() > LEAST_CELLS ? cells() - LEAST_CELLS : 0;
    for (; k < last && t < seconds; ++k) {
        const double duration = law_.time_of(k);
        out.push_back(cell_of(motion_at(k, 0), motion_at(k, 1), duration));
        t += duration;
    }
    if (k == 0) {
        return;
    }
    is_done_ = has_end_ && k == cells();
    before_ = knots_[k] - knots_[k - 1];
    knots_.erase(knots_.begin(), knots_.begin() + static_cast<long>(k));
    c_.erase(c_.begin(), c_.begin() + static_cast<long>(k));
}

}  // namespace mw::trajectory::profile

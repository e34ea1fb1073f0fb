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
/// Part of a limit that a plan leaves to the next one.
constexpr double LEAST_ROOM = 1e-6;

}  // namespace

void Profile::begin(double s) noexcept {
    start_s_ = s;
    restart();
    worst_start_ = 0;
    steps_ = 0;
}

/// Nothing is planned, at rest at the start.
void Profile::restart() noexcept {
    map_ = RestMap();
    knots_.clear();
    c_.clear();
    eased_.clear();
    time_cells_.clear();
    before_ = 0;
    has_end_ = ends_early_ = false;
    end_s_ = 0;
    joint_curve_.begin(nullptr, {});
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
    run_.cap_reach = 0;
    for (std::size_t k = 0; run.caps != nullptr && k < run.caps->size(); ++k) {
        run_.cap_reach = std::max(run_.cap_reach, (*run.caps)[k].reach);
    }
    const auto &spans = *run.spans;
    const curve::CurvePoint end = curve::point_at(spans[span_at(spans, run.end_s)], run.end_s);
    reach_ = largest_reach(end, run.limits, settings_.period_s);
    take_joints(run);
    for (std::size_t j = 0; j < joint_curve_.joints(); ++j) {
        Bounds b = bounds_of(run.joints, j);
        share(b);
        run_.joints.velocity[j] = b.velocity;
        run_.joints.acceleration[j] = b.acceleration;
        run_.joints.jerk[j] = b.jerk;
    }
    std::for_each(run_.limits.axes.begin(), run_.limits.axes.end(), share);
    share(run_.limits.xyz);
    cell_s_ = std::clamp(ramp_s / CELLS_PER_RAMP, LEAST_CELL_S, settings_.cell_s);
}

/// Computes the joints along what is known. Where there are none the run ends before.
void Profile::take_joints(const Run &run) {
    if (run.map == nullptr || run.joints.count == 0) {
        return;
    }
    if (joint_curve_.joints() == 0) {
        joint_curve_.begin(run.map, run.joints);
    }
    joint_curve_.cover(*run.spans);
    joint_curve_.drop_before(knots_.empty() ? start_s_ : map_.at(knots_[0]).s);
    run_.joint_curve = &joint_curve_;
    if (joint_curve_.drivable_s() < run_.end_s) {
        run_.end_s = joint_curve_.drivable_s();
        run_.has_stop = true;
    }
}

void Profile::lay_cells(std::size_t fixed) {
    const Run &run = run_;
    const double planned = cell_s_ * static_cast<double>(laid() - fixed);
    if (has_end_ || planned >= settings_.window_s) {
        return;
    }
    const bool is_first = knots_.empty();
    const double from = planned_s();
    // The creep that was laid before counts on the ramp before the end as long as the curve ends there.
    if (run.end_s != end_s_) {
        end_s_ = run.end_s;
        end_ramp_ = std::min(RoughProfile::ramp_at(run, run.end_s), MAX_RAMP * (run.end_s - from));
    }
    const auto &ends = rough_.lay(run, {from, is_first, settings_.window_s - planned, cell_s_, end_ramp_});
    if (ends.empty()) {
        return;
    }
    if (is_first) {
        map_.set_start(start_s_,
                       std::min(RoughProfile::ramp_at(run, start_s_), MAX_RAMP * (run.end_s - start_s_)));
        knots_.push_back(0);
    }
    const double ramp = end_ramp_;
    const bool is_end = run.has_stop && ends.back() >= run.end_s;
    if (is_end) {
        map_.set_end(run.end_s, ramp);
        has_end_ = true;
    }
    const std::size_t old = laid();
    for (const double s : ends) {
        // A stop at the end of what is known must still be possible, and what follows must not lower limits.
        if (!is_end && s > run.end_s - std::max(ramp, run.has_stop ? 0.0 : reach_)) {
            break;
        }
        const double p = is_end && s == ends.back() ? map_.end() : map_.parameter_at(s);
        // The cell behind the old end is not longer than that before it.
        const double next = old > 0 && laid() == old ? 2 * knots_[old] - knots_[old - 1] : p;
        const double left = p - next;
        if (left > 0 && (left > 0.5 * (next - knots_[old]) || !(is_end && s == ends.back()))) {
            knots_.push_back(next);
        }
        if (!(left > 0) || left > 0.5 * (next - knots_[old]) || (is_end && s == ends.back())) {
            knots_.push_back(p);
        }
    }
    if (old > 0 && laid() > old) {
        const double h = knots_[old] - knots_[old - 1];
        change_behind(h, knots_[old + 1] - knots_[old]);
    }
    if (knots_.size() > 1) {
        creep(run, map_, knots_, ramp, c_);
    } else {
        knots_.clear();  // too little of the curve is known
    }
    eased_.resize(laid());
}

/// The last coefficient for another length of the cell behind the plan: the motion stays the same.
void Profile::change_behind(double from, double to) noexcept {
    const std::size_t n = c_.size() - 2;
    const double last = knots_[n] - knots_[n - 1];
    c_[n + 1] = c_[n] + (c_[n + 1] - c_[n]) * (last + to) / (last + from);
}

/// Rows of `n` cells behind the fixed ones, and the plan as their first coefficients.
void Profile::prepare(std::size_t fixed, std::size_t n) {
    make_rows(run_, map_, &knots_[fixed], n, rows_);
    const Course course = course_from(fixed, &c_[fixed]);
    const std::size_t behind = fixed + n < laid() ? fixed + n : fixed + n - 1;
    law_.begin(rows_, course.before, knots_[behind + 1] - knots_[behind]);
    std::copy_n(c_.begin() + static_cast<long>(fixed), n + 2, law_.coefficients().begin());
}

/// Raises rows a little where the present coefficients reach them. Returns the
/// largest row.
double Profile::make_room() {
    double worst = 0;
    for (std::size_t k = 0; k < rows_.cells(); ++k) {
        for (std::size_t p = 0; p < PLACES; ++p) {
            const double row = law_.worst_at(k, p);
            worst = std::max(worst, row);
            if (row * (1 + LEAST_ROOM) > 1) {
                rows_.relax(k, p, row * (1 + LEAST_ROOM));
                rows_.allow(k, p, law_.state(k, PLACE_PART[p]).b * (1 + LEAST_ROOM));
            }
        }
    }
    return worst;
}

void Profile::store(std::size_t fixed) {
    std::copy_n(law_.coefficients().begin(), laid() - fixed + 2, c_.begin() + static_cast<long>(fixed));
}

void Profile::plan(const Run &run, std::size_t fixed) {
    const bool is_same = run.has_stop && run.end_s <= ending_s_;
    if (ends_early_ && (is_same || isInEnding() || fixed > ending_at_)) {
        return;
    }
    ends_early_ = false;
    take_limits(run);
    lay_cells(fixed);
    const std::size_t n = laid() - std::min(fixed, laid());
    if (n == 0) {
        return;
    }
    prepare(fixed, n);
    for (std::size_t k = 0; k < n; ++k) {
        for (std::size_t p = 0; p < PLACES; ++p) {
            rows_.allow(k, p, eased_[fixed + k][p]);
        }
    }
    worst_start_ = std::max(worst_start_, make_room());
    SolveSettings settings;
    settings.cell_s = cell_s_;
    const bool is_moving = fixed > 0 || before_ > 0;
    steps_ += law_.solve(is_moving ? 2 : 0, has_end_ ? 0 : 2, settings);
    store(fixed);
    make_time_cells(fixed);
}

void Profile::make_time_cells(std::size_t fixed) {
    time_cells_.resize(laid());
    const Course course = course_from(fixed, law_.coefficients().data());
    for (std::size_t k = 0; k < course.cells; ++k) {
        time_cells_[fixed + k] = cell_of(motion_at(course, k, 0), motion_at(course, k, 1), law_.time_of(k));
    }
}

void Profile::drop(std::size_t count) {
    if (count == 0) {
        return;
    }
    const std::size_t laid = ends_early_ ? std::min(count, ending_at_) : count;
    if (ends_early_) {
        ending_.erase(ending_.begin(), ending_.begin() + static_cast<long>(count - laid));
        ending_at_ -= laid;
    }
    if (laid == 0) {
        return;
    }
    before_ = knots_[laid] - knots_[laid - 1];
    const auto n = static_cast<long>(laid);
    knots_.erase(knots_.begin(), knots_.begin() + n);
    c_.erase(c_.begin(), c_.begin() + n);
    eased_.erase(eased_.begin(), eased_.begin() + n);
    time_cells_.erase(time_cells_.begin(), time_cells_.begin() + n);
}

}  // namespace mw::trajectory::profile

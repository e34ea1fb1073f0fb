// SPDX-License-Identifier: GPL-2.0-or-later
#include "trajectory/profile/profile.hh"

#include <algorithm>
#include <cmath>

namespace mw::trajectory::profile {

namespace {

/// Fractions of the limits used for planning. Limits are kept at three points of a cell, and nearly kept
/// between them.
constexpr double VELOCITY_SHARE = 0.999, ACCELERATION_SHARE = 0.998, JERK_SHARE = 0.98;
/// Fractions of the limits by which rows are raised where the start motion reaches them.
constexpr double ROOM = 5e-7, LEAST_ROOM = 1e-9;

/// If the previous plan was the fastest one, most of it remains the fastest. First the last fraction TAIL of
/// it is solved, with barriers from WARM_MU to WARM_LAST_MU, then all cells with the last barrier.
constexpr double TAIL = 0.3, WARM_MU = 2.5e-2, WARM_LAST_MU = 5e-3;
constexpr int WARM_STEPS = 5;

}  // namespace

void Profile::begin(double s) noexcept {
    start_s_ = s;
    restart();
    worst_start_ = worst_rejected_ = 0;
    steps_ = rejected_ = 0;
}

/// Removes the plan. The motion is stopped at the start.
void Profile::restart() noexcept {
    plan_ = SpeedPlan();
    forget_slowest();
    joint_curve_.begin(nullptr, {});
}

double Profile::planned_s() const noexcept {
    return plan_.knots.empty() ? start_s_ : plan_.map.at(plan_.knots.back()).s;
}

void Profile::take_limits(const Run &run) {
    run_ = run;
    const auto share = [](Bounds &b) {
        b.velocity *= VELOCITY_SHARE;
        b.acceleration *= ACCELERATION_SHARE;
        b.jerk = std::min(b.jerk * JERK_SHARE, b.acceleration / LEAST_RAMP_S);
    };
    run_.find_cap_reach();
    const auto &spans = *run.spans;
    const curve::CurvePoint end = curve::point_at(spans[span_at(spans, run.end_s)], run.end_s);
    reach_ = largest_reach(end, run.limits, settings_.period_s);
    run_.add_joints(joint_curve_, run.joints,
                    plan_.knots.empty() ? start_s_ : plan_.map.at(plan_.knots[0]).s);
    for (std::size_t j = 0; j < joint_curve_.joints(); ++j) {
        Bounds b = bounds_of(run.joints, j);
        share(b);
        run_.joints.velocity[j] = b.velocity;
        run_.joints.acceleration[j] = b.acceleration;
        run_.joints.jerk[j] = b.jerk;
    }
    std::for_each(run_.limits.axes.begin(), run_.limits.axes.end(), share);
    share(run_.limits.xyz);
}

void Profile::lay_cells(std::size_t fixed) {
    const Run &run = run_;
    // The creep at the end takes longer than the time for which its cells were made.
    double planned = 0;
    for (std::size_t k = fixed; k < std::min(plan_.laid(), plan_.time_cells.size()); ++k) {
        planned += std::min(plan_.time_cells[k].duration, plan_.laid_s[k]);
    }
    if (plan_.has_end) {
        return;
    }
    const bool is_first = plan_.knots.empty();
    const double from = planned_s();
    if (!(run.end_s > from)) {
        return;  // the joints cannot reach the path ahead
    }
    // The existing creep takes the ramp before the end into account as long as the curve ends there.
    if (run.end_s != plan_.end_s) {
        plan_.end_s = run.end_s;
        plan_.end_ramp = std::min(RoughProfile::ramp_at(run, run.end_s), MAX_RAMP * (run.end_s - from));
    }
    const double start_ramp =
        is_first ? std::min(RoughProfile::ramp_at(run, start_s_), MAX_RAMP * (run.end_s - start_s_)) : 0.0;
    const auto &ends =
        rough_.lay(run, {from, is_first, start_ramp, settings_.window_s, planned, plan_.end_ramp});
    if (ends.empty()) {
        return;
    }
    if (is_first) {
        plan_.map.set_start(start_s_, start_ramp);
        plan_.knots.push_back(0);
    }
    const double ramp = plan_.end_ramp;
    const bool is_end = run.has_stop && ends.back().s >= run.end_s;
    if (is_end) {
        plan_.map.set_end(run.end_s, ramp);
        plan_.has_end = true;
    }
    const std::size_t old = plan_.laid();
    for (const auto &[s, duration_s] : ends) {
        // A stop at the end of the known curve must remain possible, and the path after it must not lower
        // limits.
        if (!is_end && s > run.end_s - std::max(ramp, run.has_stop ? 0.0 : reach_)) {
            break;
        }
        const double p = is_end && s == ends.back().s ? plan_.map.end() : plan_.map.parameter_at(s);
        if (old > 0 && plan_.laid() == old) {
            plan_.lay_first(p);
        } else {
            plan_.knots.push_back(p);
        }
        plan_.laid_s.resize(plan_.laid(), duration_s);
    }
    if (plan_.laid() == old) {
        // Too little of the curve is known.
        if (is_first) {
            plan_.knots.clear();
        }
        return;
    }
    if (old > 0) {
        plan_.change_behind(plan_.knots[old] - plan_.knots[old - 1], plan_.knots[old + 1] - plan_.knots[old]);
    }
    plan_.lowers = !creep(run, plan_.map, plan_.knots, ramp, plan_.c) && plan_.lowers;
    plan_.eased.resize(plan_.laid());
}

/// Makes the rows of `n` cells after the fixed ones. The plan gives the first coefficients.
void Profile::prepare(std::size_t fixed, std::size_t n) {
    make_rows(run_, plan_.map, &plan_.knots[fixed], n, rows_);
    const Course course = plan_.course_from(fixed, &plan_.c[fixed]);
    const std::size_t behind = fixed + n < plan_.laid() ? fixed + n : fixed + n - 1;
    law_.begin(rows_, course.before, plan_.knots[behind + 1] - plan_.knots[behind]);
    std::copy_n(plan_.c.begin() + static_cast<long>(fixed), n + 2, law_.coefficients().begin());
}

/// Raises rows that the current coefficients reach, at most by rounding, because the solver needs slack.
/// Returns the maximum row before.
double Profile::make_room() {
    double worst = 0;
    for (std::size_t k = 0; k < rows_.cells(); ++k) {
        for (std::size_t p = 0; p < PLACES; ++p) {
            const double row = law_.worst_at(k, p);
            worst = std::max(worst, row);
            if (row > 1 - ROOM) {
                const double most = std::max(1 + ROOM, row * (1 + LEAST_ROOM));
                rows_.relax(k, p, most);
                rows_.allow(k, p, most * most / rows_.velocity(k, p));
            }
        }
    }
    return worst;
}

/// False for a start motion that exceeds a limit. It must not be executed.
bool Profile::isStart(double worst) noexcept {
    if (worst > 1 + ROUNDING) {
        worst_rejected_ = std::max(worst_rejected_, worst);
        return false;
    }
    worst_start_ = std::max(worst_start_, worst);
    return true;
}

/// Restores the previous plan. Returns false.
bool Profile::restore() noexcept {
    std::swap(plan_, kept_);
    ++rejected_;
    return false;
}

bool Profile::plan(const Run &run, std::size_t fixed) {
    const bool is_same = run.has_stop && run.end_s <= ending_s_;
    if (plan_.ends_early && (is_same || isInEnding() || fixed > ending_at_)) {
        return true;
    }
    kept_ = plan_;
    forget_slowest();
    return extend(run, fixed) || restore();
}

/// False if the motion from which the plan starts exceeds a limit.
bool Profile::extend(const Run &run, std::size_t fixed) {
    plan_.ends_early = false;
    take_limits(run);
    const std::size_t old = plan_.laid();
    const bool lowers = plan_.lowers;
    lay_cells(fixed);
    const std::size_t n = plan_.laid() - std::min(fixed, plan_.laid());
    if (n == 0) {
        return true;
    }
    if (lowers) {
        plan_.ease(std::max(old, fixed), plan_.laid());
    }
    prepare(fixed, n);
    const bool is_warm = plan_.takes_rows(rows_, fixed, old);
    for (std::size_t k = 0; k < n; ++k) {
        for (std::size_t p = 0; p < PLACES; ++p) {
            rows_.allow(k, p, plan_.eased[fixed + k][p]);
        }
    }
    if (!isStart(make_room())) {
        return false;
    }
    const bool is_moving = fixed > 0 || plan_.before > 0;
    const std::size_t end = plan_.has_end ? 0 : 2;
    SolveSettings settings;
    if (is_warm) {
        // The plan changes most at its end, where it braked for the creep.
        settings.first_mu = WARM_MU;
        settings.last_mu = WARM_LAST_MU;
        const auto stays = static_cast<double>(old - fixed) * (1 - TAIL);
        steps_ += law_.solve(2 + static_cast<std::size_t>(stays), end, settings);
        settings = SolveSettings();
        settings.first_mu = settings.last_mu;
        settings.steps_per_mu = WARM_STEPS;
    }
    steps_ += law_.solve(is_moving ? 2 : 0, end, settings);
    std::copy_n(law_.coefficients().begin(), n + 2, plan_.c.begin() + static_cast<long>(fixed));
    make_time_cells(fixed);
    plan_.is_fastest = true;
    return true;
}

void Profile::make_time_cells(std::size_t fixed) {
    plan_.time_cells.resize(plan_.laid());
    const Course course = plan_.course_from(fixed, law_.coefficients().data());
    for (std::size_t k = 0; k < course.cells; ++k) {
        plan_.time_cells[fixed + k] =
            cell_of(plan_.motion_at(course, k, 0), plan_.motion_at(course, k, 1), law_.time_of(k));
    }
}

void Profile::drop(std::size_t count) {
    if (count == 0) {
        return;
    }
    forget_slowest();
    const std::size_t laid = plan_.ends_early ? std::min(count, ending_at_) : count;
    if (plan_.ends_early) {
        ending_.erase(ending_.begin(), ending_.begin() + static_cast<long>(count - laid));
        ending_at_ -= laid;
    }
    if (laid == 0) {
        return;
    }
    plan_.drop(laid);
}

}  // namespace mw::trajectory::profile

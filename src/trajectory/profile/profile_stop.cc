// SPDX-License-Identifier: GPL-2.0-or-later
// Stops from a moving plan, and plans after limits were lowered.
#include <algorithm>
#include <cmath>

#include "trajectory/curve/curve_builder.hh"
#include "trajectory/profile/profile.hh"

namespace mw::trajectory::profile {

namespace {

/// Time between the starts of direct stops that are tried [s].
constexpr double STOPS_APART_S = 2e-3;
/// The same for PROMPT stops, as a fraction of the time before them. The slowest motion already brakes as
/// fast as possible.
constexpr double STOPS_APART = 0.25;
/// A stop of a plan may take PROMPT_SHARE times the minimum time plus PROMPT_S [s].
constexpr double PROMPT_SHARE = 1.1, PROMPT_S = 2e-3;
/// BELOW_PLAN: maximum of a floor divided by the coefficient of the plan. NEAR_CREEP: a coefficient up to
/// this multiple of the creep counts as a creep.
constexpr double BELOW_PLAN = 0.9, NEAR_CREEP = 1.02;
/// Maximum number of parts of a cell, and their minimum planned time [s]. A cell may be divided several
/// times.
constexpr double MOST_PARTS = 8, LEAST_PART_S = 2.5e-4;
/// Last barrier: fraction of the coefficients of the start below which the speed is not reduced. A plan has
/// many PROMPT stops. Their first barrier is that for a start from a slow motion.
constexpr SolveSettings SLOWEST_SOLVE{.objective = Objective::SPEED, .last_mu = 4e-3};
constexpr SolveSettings PROMPT_SOLVE{
    .objective = Objective::SPEED, .last_mu = 2e-2, .factor = 0.1, .steps_per_mu = 8};
constexpr double WARM_STOP_MU = 0.1;

}  // namespace

void Profile::begin_stops(const Run &run) {
    take_limits(run);
    forget_slowest();
    known_stops_.clear();
}

Stop Profile::next_stop(const Run &run, std::size_t fixed, StopEffort effort) {
    Stop out{cells(), {}, end_s()};
    if (fixed == 0 && plan_.before == 0) {
        return {0, {}, start_s_};
    }
    if (fixed >= (plan_.ends_early ? ending_at_ : plan_.laid()) || isInEnding()) {
        return out;
    }
    const Course course = plan_.course_from(fixed, &plan_.c[fixed]);
    DirectStop tail;
    const StopSearch search(run, run_, plan_);
    const std::size_t first =
        plan_.ends_early ? course.cells + 1 : search.first(course, fixed, known_stops_, tail);
    if (first <= course.cells) {
        out = {fixed + first, {tail.cells.begin(), tail.cells.end()}, tail.end_s};
    }
    if (effort == StopEffort::SOONEST) {
        stop_sooner(run, fixed, 0, out);
        forget_slowest();  // the next call may follow a change of the plan
    } else if (effort == StopEffort::PROMPT) {
        const double enough_s = PROMPT_SHARE * search.least_s(course) + PROMPT_S;
        if (time_of(out, fixed) > enough_s) {
            stop_sooner(run, fixed, enough_s, out);
        }
    }
    return out;
}

/// Time from the start of cell `fixed` to the end of the stop [s]. An incomplete plan has no stop at its end.
double Profile::time_of(const Stop &stop, std::size_t fixed) const {
    if (stop.cells.empty() && !isComplete()) {
        return StopSearch::ANYWHERE;
    }
    double time_s = 0;
    for (std::size_t k = fixed; k < stop.kept; ++k) {
        time_s += cell(k).duration;
    }
    for (const TimeCell &cell : stop.cells) {
        time_s += cell.duration;
    }
    return time_s;
}

/// Searches a stop from the slowest motion and replaces `out` if it is sooner. `enough_s`: a stop in less
/// time is accepted at once; 0: the soonest one.
void Profile::stop_sooner(const Run &run, std::size_t fixed, double enough_s, Stop &out) {
    const Course plan = plan_.course_from(fixed, &plan_.c[fixed]);
    const StopSearch search(run, run_, plan_);
    double least = time_of(out, fixed);
    const double apart = enough_s > 0 ? STOPS_APART : 0;
    for (std::size_t n = search.cells_of_stop(plan);; n = std::min(2 * n, plan.cells)) {
        n = fixed <= slowest_.from && fixed < slowest_.end ? std::min(n, slowest_.end - fixed) : n;
        const SolveSettings settings = enough_s > 0 ? PROMPT_SOLVE : SLOWEST_SOLVE;
        if (!make_slowest(fixed, n, {}, settings)) {
            return;
        }
        const Course course = plan_.course_from(fixed, law_.coefficients().data()).first(n);
        DirectStop tail;
        std::size_t kept = n + 1;
        double before = 0;
        double next = 0;
        for (std::size_t k = 0; k <= n && before < least && least > enough_s; ++k) {
            DirectStop found;
            if ((before >= next || k == n) &&
                search.find(course, k, {least - before, StopSearch::ANYWHERE}, found)) {
                least = before + found.duration();
                kept = k;
                tail = found;
            }
            next = before >= next ? before + STOPS_APART_S + apart * before : next;
            before += k < n ? law_.time_of(k) : 0.0;
        }
        if (kept <= n) {
            out = {fixed, {}, tail.end_s};
            for (std::size_t i = 0; i < kept; ++i) {
                out.cells.push_back(
                    cell_of(plan_.motion_at(course, i, 0), plan_.motion_at(course, i, 1), law_.time_of(i)));
            }
            out.cells.insert(out.cells.end(), tail.cells.begin(), tail.cells.end());
        }
        const bool is_done = kept <= n || n == plan.cells || before >= least;
        if (is_done) {
            slowest_ = {law_.coefficients(), fixed, fixed + n};
            return;
        }
        forget_slowest();
    }
}

/// Reduces the speed in `n` cells after the fixed ones to the minimum within the limits of acceleration and
/// jerk, but not below `floors` (none: 0). Without floors, it starts with the known slowest motion and the
/// plan before it, which are within every row. False if the plan exceeds a limit.
bool Profile::make_slowest(std::size_t fixed, std::size_t n, const std::vector<double> &floors,
                           SolveSettings settings) {
    prepare(fixed, n);
    const Course course = plan_.course_from(fixed, &plan_.c[fixed]);
    for (std::size_t k = 0; k < n; ++k) {
        for (std::size_t p = 0; p < PLACES; ++p) {
            rows_.allow(k, p, course.state(k, PLACE_PART[p]).b * (1 + ABOVE_LOWEST));
        }
    }
    settings.reference = &plan_.c[fixed];
    if (floors.empty() && fixed <= slowest_.from && fixed + n <= slowest_.end) {
        const std::size_t same = slowest_.from - fixed;
        for (std::size_t i = same + 2; i < n + 2; ++i) {
            law_.coefficients()[i] = slowest_.c[i - same];
        }
        settings.first_mu = WARM_STOP_MU;
    }
    if (!isStart(make_room())) {
        return false;
    }
    const std::size_t start = fixed > 0 || plan_.before > 0 ? 2 : 0;
    for (std::size_t i = 0; i < std::min(floors.size(), n + 2); ++i) {
        law_.floors()[i] = floors[i];
        if (i >= start && floors[i] > 0) {
            settings.first_mu = std::max(settings.first_mu, course.c[i] / floors[i]);
        }
    }
    steps_ += law_.solve(start, 0, settings);
    return true;
}

/// Number of parts of a cell within `length` of the start in which the speed will be lower.
int Profile::parts_of(const Run &run, const Course &course, std::size_t k, double length) const {
    const Motion from = plan_.motion_at(course, 0, 0), m = plan_.motion_at(course, k, 0.5);
    const std::size_t span = span_at(*run.spans, m.s);
    const double limit = 1 / speed_share(run, curve::point_at((*run.spans)[span], m.s), run.feed_at(m.s));
    const double braked = from.v * std::sqrt(std::max(1 - (m.s - from.s) / (0.5 * length), 0.0));
    const double lowest = std::max({limit, braked, m.v / MOST_PARTS});
    const double time_s = (course.knots[k + 1] - course.knots[k]) / std::sqrt(course.state(k, 0.5).b);
    const double most = std::max(time_s / LEAST_PART_S, 1.0);
    return static_cast<int>(std::min(std::ceil(m.v / lowest), most));
}

/// True if the motion in a cell is within the acceleration and jerk limits also at the points of its parts.
/// They may show details between the points of the cell.
bool Profile::keepsRows(const Course &course, std::size_t k, int parts) {
    const double from = course.knots[k], h = course.knots[k + 1] - from;
    part_knots_.clear();
    for (int i = 0; i <= parts; ++i) {
        part_knots_.push_back(i == parts ? course.knots[k + 1] : from + h * i / parts);
    }
    make_rows(run_, plan_.map, part_knots_.data(), static_cast<std::size_t>(parts), rows_);
    for (std::size_t i = 0; i < rows_.cells(); ++i) {
        for (std::size_t p = 0; p < PLACES; ++p) {
            const double x = (static_cast<double>(i) + PLACE_PART[p]) / parts;
            if (rows_.worst(i, p, course.state(k, x)) > 1 + ROUNDING) {
                return false;
            }
        }
    }
    return true;
}

/// Divides the first `n` cells after the fixed ones if the speed will be lower there and the parts are within
/// every row. The motion remains the same. Returns the new number of cells.
std::size_t Profile::split(const Run &run, std::size_t fixed, std::size_t n) {
    const Course course = plan_.course_from(fixed, &plan_.c[fixed]);
    const double length = plan_.map.at(course.knots[n]).s - plan_.map.at(course.knots[0]).s;
    split_.knots.assign(plan_.knots.begin(), plan_.knots.begin() + static_cast<long>(fixed) + 1);
    split_.c.assign(plan_.c.begin(), plan_.c.begin() + static_cast<long>(fixed) + 1);
    for (std::size_t k = 0; k < course.cells; ++k) {
        const double h = course.knots[k + 1] - course.knots[k];
        const int parts = k + 1 < course.cells && k < n ? parts_of(run, course, k, length) : 1;
        if (parts == 1 || !keepsRows(course, k, parts)) {
            split_.knots.push_back(course.knots[k + 1]);
            split_.c.push_back(course.c[k + 1]);
            continue;
        }
        // The coefficient of a part from x to y is b + a (x + y) + w x y, with b, a, w at the start of the
        // cell.
        const LawState start = course.state(k, 0);
        for (int i = 0; i < parts; ++i) {
            const double x = h * i / parts, y = h * (i + 1) / parts;
            split_.knots.push_back(i + 1 == parts ? course.knots[k + 1] : course.knots[k] + y);
            split_.c.push_back(start.b + start.a * (x + y) + start.w * x * y);
        }
    }
    split_.c.push_back(course.c[course.cells + 1]);
    const double end = course.knots[n];
    plan_.knots.swap(split_.knots);
    plan_.c.swap(split_.c);
    plan_.eased.resize(plan_.laid());
    plan_.laid_s.assign(plan_.laid(), 1e300);
    const auto last = std::lower_bound(plan_.knots.begin(), plan_.knots.end(), end);
    return static_cast<std::size_t>(last - plan_.knots.begin()) - fixed;
}

/// Reduces the speed after the fixed cells as soon as the limits allow. The plan then ends in a creep. The
/// motion may exceed lowered speed limits from now on. False if the plan exceeds a limit.
bool Profile::slow_down(const Run &run, std::size_t fixed) {
    std::size_t n = StopSearch(run, run_, plan_).cells_of_stop(plan_.course_from(fixed, &plan_.c[fixed]));
    n = split(run, fixed, n);
    creep_.clear();
    creep(run_, plan_.map, plan_.knots, plan_.end_ramp, creep_);
    creep_.erase(creep_.begin(), creep_.begin() + static_cast<long>(fixed));
    floors_ = creep_;
    for (std::size_t i = 0; i < floors_.size(); ++i) {
        floors_[i] = std::min(creep_[i], BELOW_PLAN * plan_.c[fixed + i]);
    }
    std::size_t kept = 0;
    for (;; n = std::min(2 * n, plan_.laid() - fixed)) {
        if (!make_slowest(fixed, n, floors_, SLOWEST_SOLVE)) {
            return false;
        }
        const std::vector<double> &c = law_.coefficients();
        const auto creeps = [&](std::size_t k) {
            const auto is_near = [&](std::size_t i) { return c[i] <= creep_[i] * NEAR_CREEP; };
            const double *p = &plan_.knots[fixed + k];
            return is_near(k - 1) && is_near(k) && is_near(k + 1) &&
                   isSteady(run_, c[k - 1], c[k], p[0] - p[-1]) &&
                   isSteady(run_, c[k], c[k + 1], p[0] - p[-1]);
        };
        kept = 2;
        while (kept < n && !creeps(kept)) {
            ++kept;
        }
        kept = std::min(kept, n);
        // A ramp before the end remains.
        kept = plan_.has_end && plan_.knots[fixed + kept] > plan_.map.end_ramp() ? n : kept;
        if (kept < n || n == plan_.laid() - fixed) {
            break;
        }
    }
    std::copy_n(law_.coefficients().begin(), kept + 2, plan_.c.begin() + static_cast<long>(fixed));
    if (fixed + kept < plan_.laid()) {
        plan_.cut(fixed + kept);
    }
    plan_.lowers = true;
    plan_.is_fastest = false;
    plan_.ease(0, plan_.laid());
    return true;
}

/// True if the end of the run is so near that the planned motion does not take it into account.
bool Profile::endsNear(const Run &run) const noexcept {
    if (!run.has_stop || run.end_s >= plan_.end_s) {
        return false;
    }
    const double left = run.end_s - planned_s();
    const double ramp = std::min(RoughProfile::ramp_at(run_, run.end_s), MAX_RAMP * left);
    return left <= 0 || creep_scale(run_, plan_.c.back()) >
                            RestMap::scale_of(ramp) + curve::SPACING_GROWTH * (left - ramp);
}

/// Ends the plan with a direct stop at the end of the run. False if no direct stop is within the limits.
bool Profile::end_early(const Run &run, std::size_t fixed) {
    take_limits(run);
    const Course course = plan_.course_from(fixed, &plan_.c[fixed]);
    const StopSearch search(run, run_, plan_);
    DirectStop tail;
    double before = 0, next = 0, least = StopSearch::ANYWHERE;
    for (std::size_t k = 0; k < course.cells && before < least; ++k) {
        DirectStop found;
        if (before >= next && search.find(course, k, {least - before, run.end_s}, found)) {
            least = before + found.duration();
            tail = found;
            ending_at_ = fixed + k;
        }
        next = before >= next ? before + STOPS_APART_S : next;
        before += plan_.time_cells[fixed + k].duration;
    }
    plan_.ends_early = least < StopSearch::ANYWHERE;
    if (plan_.ends_early) {
        ending_.assign(tail.cells.begin(), tail.cells.end());
        ending_cells_ = ending_.size();
        ending_s_ = run.end_s;
    }
    return plan_.ends_early;
}

bool Profile::replan(const Run &run, std::size_t fixed) {
    if (isInEnding() || (plan_.ends_early && fixed > ending_at_)) {
        return true;
    }
    kept_ = plan_;
    forget_slowest();
    return change(run, fixed) || restore();
}

/// False if a motion from which this starts exceeds a limit.
bool Profile::change(const Run &run, std::size_t fixed) {
    plan_.ends_early = false;
    take_limits(run);
    if (fixed == 0 && plan_.before == 0) {
        restart();
        return extend(run, fixed);
    }
    if (plan_.laid() <= fixed) {
        return extend(run, fixed);
    }
    Run whole = run;
    Stop soonest;
    const bool is_near = endsNear(run);
    if (is_near) {
        whole.end_s = plan_.end_s;
        whole.has_stop = plan_.has_end;
        soonest = stop(run, fixed, StopEffort::SOONEST);
        for (std::size_t k = soonest.kept; k-- > fixed;) {
            soonest.cells.insert(soonest.cells.begin(), cell(k));
        }
        take_limits(whole);
    }
    if (!slow_down(whole, fixed) || !extend(whole, fixed)) {
        return false;
    }
    if (!is_near || end_early(run, fixed)) {
        return true;
    }
    // Try again from the slowest motion with its creep.
    take_limits(whole);
    if (!slow_down(whole, fixed)) {
        return false;
    }
    lay_cells(fixed);
    plan_.ease(fixed, plan_.laid());
    prepare(fixed, plan_.laid() - fixed);
    make_time_cells(fixed);
    if (!end_early(run, fixed)) {
        // Use the soonest stop, before the end of the run.
        plan_.ends_early = true;
        ending_at_ = fixed;
        ending_ = soonest.cells;
        ending_cells_ = ending_.size();
        ending_s_ = soonest.end_s;
    }
    return true;
}

}  // namespace mw::trajectory::profile

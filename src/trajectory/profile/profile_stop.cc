// SPDX-License-Identifier: GPL-2.0-or-later
// Stops in the middle of a plan, and plans after limits were lowered.
#include <algorithm>
#include <cmath>

#include "trajectory/curve/curve_builder.hh"
#include "trajectory/profile/profile.hh"

namespace mw::trajectory::profile {

namespace {

/// Time between the places where a stop from the least speed or at a place begins [s].
constexpr double STOPS_APART_S = 2e-3;
/// The same for PROMPT stops, as a part of the time before: the slowest motion brakes as fast as it can.
constexpr double STOPS_APART = 0.25;
/// A stop of a plan may take so many times the least time, and so much more.
constexpr double PROMPT_SHARE = 1.1, PROMPT_S = 2e-3;
/// Parts of the plan and of the creep: a floor is below the plan, and what is near the floor creeps.
constexpr double BELOW_PLAN = 0.9, NEAR_CREEP = 1.02;
/// Parts of a cell at most, and their least time as planned [s]: a cell may be split again and again.
constexpr double MOST_PARTS = 8, LEAST_PART_S = 2.5e-4;
/// The last barrier: part of the coefficients of the start below which speed is not reduced. A plan has many
/// PROMPT stops; the first barrier is that from a motion that is slow already.
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
        forget_slowest();  // it may be asked for while the plan is being changed
    } else if (effort == StopEffort::PROMPT) {
        const double enough_s = PROMPT_SHARE * search.least_s(course) + PROMPT_S;
        if (time_of(out, fixed) > enough_s) {
            stop_sooner(run, fixed, enough_s, out);
        }
    }
    return out;
}

/// From the start of cell `fixed` to the end of the stop. A plan that is not complete ends in none.
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

/// From the motion with the least speed, where that is sooner. `enough_s`: a stop in less time is taken at
/// once; 0: the soonest one.
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

/// The speed in `n` cells behind the fixed ones as small as the limits of acceleration and jerk allow, down
/// to `floors` (none: 0). Without floors it begins with the slowest motion behind a place and the plan before
/// it, if that is known: it keeps every row. False if the plan leaves a limit.
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

/// Parts of a cell within `length` of the start in which the speed will be lower.
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

/// True if the motion in a cell keeps limits of acceleration and jerk at the places of its parts, too: they
/// may show what lies between the places of the cell.
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

/// Splits the first `n` cells behind the fixed ones where the speed will be lower and the parts keep every
/// row; they are the same motion. Returns how many there are then.
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
        // The coefficient of a part from x to y is b + a (x + y) + w x y, with those of the start of the
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

/// The speed behind the fixed cells is reduced as soon as limits allow, then the plan ends in a creep. What
/// is above lowered limits of the speed is allowed from now on. False if the plan leaves a limit.
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
        // A ramp before the end stays.
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

/// True if the run ends so near that what is planned does not count on it.
bool Profile::endsNear(const Run &run) const noexcept {
    if (!run.has_stop || run.end_s >= plan_.end_s) {
        return false;
    }
    const double left = run.end_s - planned_s();
    const double ramp = std::min(RoughProfile::ramp_at(run_, run.end_s), MAX_RAMP * left);
    return left <= 0 || creep_scale(run_, plan_.c.back()) >
                            RestMap::scale_of(ramp) + curve::SPACING_GROWTH * (left - ramp);
}

/// Ends the plan with a direct stop at the end of the run. False if none keeps the limits.
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

/// False if a plan that this begins with leaves a limit.
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
    // From the motion with the least speed and its creep.
    take_limits(whole);
    if (!slow_down(whole, fixed)) {
        return false;
    }
    lay_cells(fixed);
    plan_.ease(fixed, plan_.laid());
    prepare(fixed, plan_.laid() - fixed);
    make_time_cells(fixed);
    if (!end_early(run, fixed)) {
        // The soonest stop, before the end of the run.
        plan_.ends_early = true;
        ending_at_ = fixed;
        ending_ = soonest.cells;
        ending_cells_ = ending_.size();
        ending_s_ = soonest.end_s;
    }
    return true;
}

}  // namespace mw::trajectory::profile

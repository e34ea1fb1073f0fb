// SPDX-License-Identifier: GPL-2.0-or-later
// Stops in the middle of a plan, and plans after limits were lowered.
#include <algorithm>
#include <cmath>

#include "trajectory/curve/curve_builder.hh"
#include "trajectory/profile/profile.hh"

namespace mw::trajectory::profile {

namespace {

/// Places of a direct stop at which limits are checked, and how often it is made again with what they leave.
constexpr int TAIL_PLACES = 16;
constexpr double SPAN_PLACES = 12;
constexpr int TAIL_ROUNDS = 4;
/// Time between these places, and between the places where a stop from the least speed or at a place begins,
/// at most [s].
constexpr double MOST_STEP_S = 2e-3, STOPS_APART_S = 2e-3;
constexpr double ANYWHERE = 1e300;
/// Places that are checked for a quick stop, about: 0.2 ms.
constexpr std::size_t QUICK_PLACES = 400;
/// Parts of the plan and of the creep: a floor is below the plan, and what is near the floor creeps.
constexpr double BELOW_PLAN = 0.9, NEAR_CREEP = 1.02;
/// Parts of a cell at most.
constexpr double MOST_PARTS = 8;
/// Part of the coefficients of the start below which speed is not reduced.
constexpr double LAST_MU = 4e-3;

bool isStraight(const Span &span) noexcept {
    for (std::size_t n = 2; n < span.c.size(); ++n) {
        if (std::ranges::any_of(span.c[n].c, [](double x) { return x != 0; })) {
            return false;
        }
    }
    return true;
}

/// From a place to the end of its span nothing changes what the limits leave: the curve is straight, with one
/// feed and no seam near.
bool isPlain(const Run &run, const Span &span, std::size_t feed, const Motion &at) noexcept {
    if (run.joint_curve != nullptr || !isStraight(span) || (*run.feeds)[feed].end_s < span.end_s()) {
        return false;
    }
    bool has_cap = false;
    run.each_cap(at.s, span.end_s(), [&](const SpeedCap &) { has_cap = true; });
    return !has_cap;
}

}  // namespace

/// Also reduces `least` to what limits leave.
bool Profile::keepsLimits(const Run &run, const Course &course, std::size_t cell, const DirectStop &tail,
                          Density density, Rates &least) const {
    if (!(tail.end_s <= run.end_s)) {
        return false;
    }
    const auto &spans = *run.spans;
    const double duration = tail.duration();
    std::size_t span = span_at(spans, tail.cells[0].c[0]);
    std::size_t feed = run.feed_at(tail.cells[0].c[0]);
    bool keeps = true;
    double phase_end = tail.cells[0].duration;
    std::size_t phase = 0;
    for (double t = 0, step = 0;;) {
        const Motion m = tail.at(t);
        while (span + 1 < spans.size() && m.s >= spans[span].end_s()) {
            ++span;
        }
        while (feed + 1 < run.feeds->size() && m.s > (*run.feeds)[feed].end_s) {
            ++feed;
        }
        ++places_;
        const CurvePoint point = curve::point_at(spans[span], m.s);
        const Rates left = rates_at(run_, point, m);
        least.acceleration = std::min(least.acceleration, left.acceleration);
        least.jerk = std::min(least.jerk, left.jerk);
        keeps = keeps && -m.a >= left.least - left.spare_acceleration &&
                -m.a <= left.acceleration + left.spare_acceleration &&
                std::abs(tail.jerk_at(t)) <= left.jerk + left.spare_jerk;
        // Above the limit of the speed it may be where the plan is.
        if (std::max(speed_share(run, point, feed), left.speed_share) * m.v > 1) {
            const double p = plan_.map.parameter_at(m.s);
            while (cell + 1 < course.cells && course.knots[cell + 1] <= p) {
                ++cell;
            }
            const double x = (p - course.knots[cell]) / (course.knots[cell + 1] - course.knots[cell]);
            keeps = keeps && x <= 1 && m.v <= plan_.motion_at(course, cell, x).v * (1 + 1e-9);
        }
        if (!(least.acceleration > 0) || !(least.jerk > 0)) {
            return false;
        }
        if (t >= duration) {
            return keeps;
        }
        step = duration / TAIL_PLACES;
        if (density == Density::EVERY_SPAN) {
            const double v = std::max(m.v, 1e-300), to_end = (spans[span].end_s() - m.s) / v;
            const double fine = std::min(MOST_STEP_S, spans[span].length / SPAN_PLACES / v);
            step = std::min(step, to_end > fine && isPlain(run_, spans[span], feed, m) ? to_end : fine);
        }
        while (phase + 1 < DirectStop::PHASES && t >= phase_end) {
            phase_end += tail.cells[++phase].duration;
        }
        t = std::min({t + step, phase_end, duration});
    }
}

/// A direct stop from the start of a cell.
bool Profile::find_tail(const Run &run, const Course &course, std::size_t cell, const Goal &goal,
                        DirectStop &tail) const {
    const bool is_last = cell == course.cells;
    const std::size_t in = is_last ? cell - 1 : cell;
    const Motion from = plan_.motion_at(course, in, is_last ? 1 : 0);
    const std::size_t span = span_at(*run.spans, from.s);
    Rates rates = rates_at(run_, curve::point_at((*run.spans)[span], from.s), from);
    for (int round = 0; round < TAIL_ROUNDS; ++round) {
        const bool is_made = rates.acceleration > 0 && rates.jerk > 0 &&
                             (goal.end_s < ANYWHERE ? make_direct_stop_at(from, rates, goal.end_s, tail)
                                                    : make_direct_stop(from, rates, tail));
        if (!is_made || !(tail.duration() < goal.most_s)) {
            return false;
        }
        if (keepsLimits(run, course, in, tail, Density::COARSE, rates) &&
            keepsLimits(run, course, in, tail, Density::EVERY_SPAN, rates)) {
            return true;
        }
    }
    return false;
}

/// The first cell from whose start a direct stop passes; cells + 1: none. Looks further and further ahead,
/// then between that and the last that does not pass.
std::size_t Profile::first_tail(const Run &run, const Course &course, DirectStop &tail) const {
    const std::size_t n = course.cells;
    std::size_t fails = 0, passes = n + 1;
    places_ = 0;
    const auto isNear = [&] { return passes <= n && passes <= fails + 1 + passes / 8; };
    for (std::size_t k = 0, step = 1; passes > 0 && !isNear() && k <= n;) {
        DirectStop found;
        if (find_tail(run, course, k, {}, found)) {
            tail = found;
            passes = k;
        } else {
            fails = k;
        }
        const bool is_late = places_ > QUICK_PLACES;
        if (passes <= n && is_late) {
            break;
        }
        if (passes <= n) {
            k = (fails + passes) / 2;
        } else if (is_late && k < n) {
            k = n;  // the creep
        } else {
            k = k == n ? n + 1 : std::min(k + step, n);
            step *= 2;
        }
    }
    return passes;
}

Stop Profile::stop(const Run &run, std::size_t fixed, StopEffort effort) {
    take_limits(run);
    Stop out{cells(), {}, end_s()};
    if (fixed == 0 && plan_.before == 0) {
        return {0, {}, start_s_};
    }
    if (fixed >= (plan_.ends_early ? ending_at_ : plan_.laid()) || isInEnding()) {
        return out;
    }
    const Course course = plan_.course_from(fixed, &plan_.c[fixed]);
    DirectStop tail;
    const std::size_t first = plan_.ends_early ? course.cells + 1 : first_tail(run, course, tail);
    if (first <= course.cells) {
        out = {fixed + first, {tail.cells.begin(), tail.cells.end()}, tail.end_s};
    }
    if (effort == StopEffort::SOONEST) {
        stop_sooner(run, fixed, out);
    }
    return out;
}

/// Cells behind the fixed ones in which a stop is looked for first: some more than a direct stop takes on a
/// straight line.
std::size_t Profile::cells_of_stop(const Run &run, const Course &course) const {
    const Motion from = plan_.motion_at(course, 0, 0);
    const CurvePoint point = curve::point_at((*run.spans)[span_at(*run.spans, from.s)], from.s);
    const Rates rates = rates_at(run_, point, {from.s, 0, 0});
    const double reached = from.v + 0.5 * from.a * std::abs(from.a) / rates.jerk;
    const double ramp =
        std::max(rates.acceleration / rates.jerk, std::sqrt(std::max(reached, 0.0) / rates.jerk));
    const double length = from.v * (from.v / rates.acceleration + ramp);
    std::size_t n = 1;
    while (n < course.cells && plan_.map.at(course.knots[n]).s < from.s + length) {
        ++n;
    }
    return n;
}

/// From the motion with the least speed, where that is sooner.
void Profile::stop_sooner(const Run &run, std::size_t fixed, Stop &out) {
    const Course plan = plan_.course_from(fixed, &plan_.c[fixed]);
    double least = 0;
    for (std::size_t k = fixed; k < out.kept; ++k) {
        least += cell(k).duration;
    }
    for (const TimeCell &cell : out.cells) {
        least += cell.duration;
    }
    for (std::size_t n = cells_of_stop(run, plan);; n = std::min(2 * n, plan.cells)) {
        if (!make_slowest(fixed, n, {})) {
            return;
        }
        Course course = plan_.course_from(fixed, law_.coefficients().data());
        course.cells = n;
        DirectStop tail;
        std::size_t kept = n + 1;
        double before = 0;
        double next = 0;
        for (std::size_t k = 0; k <= n && before < least; ++k) {
            DirectStop found;
            if ((before >= next || k == n) && find_tail(run, course, k, {least - before, ANYWHERE}, found)) {
                least = before + found.duration();
                kept = k;
                tail = found;
            }
            next = before >= next ? before + STOPS_APART_S : next;
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
        if (kept <= n || n == plan.cells || before >= least) {
            return;
        }
    }
}

/// The speed in `n` cells behind the fixed ones as small as the limits of acceleration and jerk allow, down
/// to `floors` (none: 0). False if the plan leaves a limit.
bool Profile::make_slowest(std::size_t fixed, std::size_t n, const std::vector<double> &floors) {
    prepare(fixed, n);
    const Course course = plan_.course_from(fixed, &plan_.c[fixed]);
    for (std::size_t k = 0; k < n; ++k) {
        for (std::size_t p = 0; p < PLACES; ++p) {
            rows_.allow(k, p, course.state(k, PLACE_PART[p]).b * (1 + ABOVE_LOWEST));
        }
    }
    if (!isStart(make_room())) {
        return false;
    }
    const std::size_t start = fixed > 0 || plan_.before > 0 ? 2 : 0;
    SolveSettings settings;
    settings.objective = Objective::SPEED;
    settings.last_mu = LAST_MU;
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
    return static_cast<int>(std::ceil(std::max(m.v / lowest, 1.0)));
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
    std::size_t n = cells_of_stop(run, plan_.course_from(fixed, &plan_.c[fixed]));
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
        if (!make_slowest(fixed, n, floors_)) {
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
    DirectStop tail;
    double before = 0, next = 0, least = ANYWHERE;
    for (std::size_t k = 0; k < course.cells && before < least; ++k) {
        DirectStop found;
        if (before >= next && find_tail(run, course, k, {least - before, run.end_s}, found)) {
            least = before + found.duration();
            tail = found;
            ending_at_ = fixed + k;
        }
        next = before >= next ? before + STOPS_APART_S : next;
        before += plan_.time_cells[fixed + k].duration;
    }
    plan_.ends_early = least < ANYWHERE;
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

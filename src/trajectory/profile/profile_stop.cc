// SPDX-License-Identifier: GPL-2.0-or-later
// Stops in the middle of a plan, and plans after limits were lowered.
#include <algorithm>
#include <cmath>

#include "trajectory/profile/profile.hh"

namespace mw::trajectory::profile {

namespace {

/// Places of a direct stop at which limits are checked, and how often it is made again with what they leave.
constexpr int TAIL_PLACES = 16;
constexpr double SPAN_PLACES = 12;
constexpr int TAIL_ROUNDS = 4;
/// Part by which the speed may exceed that of the soonest braking, squared.
constexpr double ABOVE_LOWEST = 1e-3;
/// Part of the coefficients of the start below which speed is not reduced.
constexpr double LAST_MU = 1e-2;

}  // namespace

Course Profile::course_from(std::size_t fixed, const double *c) const noexcept {
    const double *knots = &knots_[fixed];
    const double before = fixed > 0 ? knots[0] - knots[-1] : before_ > 0 ? before_ : knots[1] - knots[0];
    return {knots, c, cells() - fixed, before};
}

LawState Course::state(std::size_t k, double x) const noexcept {
    const double h = knots[k + 1] - knots[k];
    const double h_before = k > 0 ? knots[k] - knots[k - 1] : before;
    const double h_behind = k + 1 < cells ? knots[k + 2] - knots[k + 1] : h;
    const double slope = (c[k + 1] - c[k]) / (h_before + h);
    const double next = (c[k + 2] - c[k + 1]) / (h + h_behind);
    return {c[k + 1] - h * slope + h * ((2 * x - x * x) * slope + x * x * next), (1 - x) * slope + x * next,
            (next - slope) / h};
}

Motion Profile::motion_at(const Course &course, std::size_t cell, double x) const noexcept {
    const LawState state = course.state(cell, x);
    const MapPoint m = map_.at(course.knots[cell] + x * (course.knots[cell + 1] - course.knots[cell]));
    return {m.s, m.first * std::sqrt(state.b), m.second * state.b + m.first * state.a};
}

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
        const CurvePoint point = curve::point_at(spans[span], m.s);
        const Rates left = rates_at(run_, point, m);
        least.acceleration = std::min(least.acceleration, left.acceleration);
        least.jerk = std::min(least.jerk, left.jerk);
        keeps = keeps && -m.a >= left.least - left.spare_acceleration &&
                -m.a <= left.acceleration + left.spare_acceleration &&
                std::abs(tail.jerk_at(t)) <= left.jerk + left.spare_jerk;
        // Above the limit of the speed it may be where the plan is.
        if (speed_share(run, point, feed) * m.v > 1) {
            const double p = map_.parameter_at(m.s);
            while (cell + 1 < course.cells && course.knots[cell + 1] <= p) {
                ++cell;
            }
            const double x = (p - course.knots[cell]) / (course.knots[cell + 1] - course.knots[cell]);
            keeps = keeps && x <= 1 && m.v <= motion_at(course, cell, x).v * (1 + 1e-9);
        }
        if (!(least.acceleration > 0) || !(least.jerk > 0)) {
            return false;
        }
        if (t >= duration) {
            return keeps;
        }
        step = duration / TAIL_PLACES;
        if (density == Density::EVERY_SPAN) {
            step = std::min({step, cell_s_, spans[span].length / SPAN_PLACES / std::max(m.v, 1e-300)});
        }
        while (phase + 1 < DirectStop::PHASES && t >= phase_end) {
            phase_end += tail.cells[++phase].duration;
        }
        t = std::min({t + step, phase_end, duration});
    }
}

/// A direct stop from the start of a cell, of less than `most_s`.
bool Profile::find_tail(const Run &run, const Course &course, std::size_t cell, double most_s,
                        DirectStop &tail) const {
    const bool is_last = cell == course.cells;
    const std::size_t in = is_last ? cell - 1 : cell;
    const Motion from = motion_at(course, in, is_last ? 1 : 0);
    const std::size_t span = span_at(*run.spans, from.s);
    Rates rates = rates_at(run_, curve::point_at((*run.spans)[span], from.s), from);
    for (int round = 0; round < TAIL_ROUNDS; ++round) {
        if (!(rates.acceleration > 0) || !(rates.jerk > 0) || !make_direct_stop(from, rates, tail) ||
            !(tail.duration() < most_s)) {
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
    for (std::size_t k = 0, step = 1; passes > 0 && passes > fails + 1 + passes / 8 && k <= n;) {
        DirectStop found;
        if (find_tail(run, course, k, 1e300, found)) {
            tail = found;
            passes = k;
        } else {
            fails = k;
        }
        if (passes <= n) {
            k = (fails + passes) / 2;
        } else {
            k = k == n ? n + 1 : std::min(k + step, n);
            step *= 2;
        }
    }
    return passes;
}

Stop Profile::stop(const Run &run, std::size_t fixed, StopEffort effort) {
    take_limits(run);
    Stop out{cells(), {}, planned_s()};
    if (cells() == fixed) {
        return out;
    }
    const Course course = course_from(fixed, &c_[fixed]);
    DirectStop tail;
    const std::size_t first = first_tail(run, course, tail);
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
    const Motion from = motion_at(course, 0, 0);
    const CurvePoint point = curve::point_at((*run.spans)[span_at(*run.spans, from.s)], from.s);
    const Rates rates = rates_at(run_, point, {from.s, 0, 0});
    const double reached = from.v + 0.5 * from.a * std::abs(from.a) / rates.jerk;
    const double ramp =
        std::max(rates.acceleration / rates.jerk, std::sqrt(std::max(reached, 0.0) / rates.jerk));
    const double length = from.v * (from.v / rates.acceleration + ramp);
    std::size_t n = 1;
    while (n < course.cells && map_.at(course.knots[n]).s < from.s + length) {
        ++n;
    }
    return n;
}

/// From the motion with the least speed, where that is sooner.
void Profile::stop_sooner(const Run &run, std::size_t fixed, Stop &out) {
    const Course plan = course_from(fixed, &c_[fixed]);
    double least = 0;
    for (std::size_t k = fixed; k < out.kept; ++k) {
        least += time_cells_[k].duration;
    }
    for (const TimeCell &cell : out.cells) {
        least += cell.duration;
    }
    for (std::size_t n = cells_of_stop(run, plan);; n = std::min(2 * n, plan.cells)) {
        make_slowest(fixed, n, LAST_MU);
        Course course = course_from(fixed, law_.coefficients().data());
        course.cells = n;
        DirectStop tail;
        std::size_t kept = n + 1;
        double before = 0;
        double next = 0;
        for (std::size_t k = 0; k <= n && before < least; ++k) {
            DirectStop found;
            if ((before >= next || k == n) && find_tail(run, course, k, least - before, found)) {
                least = before + found.duration();
                kept = k;
                tail = found;
            }
            next = before >= next ? before + settings_.cell_s : next;
            before += k < n ? law_.time_of(k) : 0.0;
        }
        if (kept <= n) {
            out = {fixed, {}, tail.end_s};
            for (std::size_t i = 0; i < kept; ++i) {
                out.cells.push_back(
                    cell_of(motion_at(course, i, 0), motion_at(course, i, 1), law_.time_of(i)));
            }
            out.cells.insert(out.cells.end(), tail.cells.begin(), tail.cells.end());
        }
        if (kept <= n || n == plan.cells || before >= least) {
            return;
        }
    }
}

/// The speed in `n` cells behind the fixed ones as small as the limits of acceleration and jerk allow.
void Profile::make_slowest(std::size_t fixed, std::size_t n, double last_mu) {
    prepare(fixed, n);
    const Course course = course_from(fixed, &c_[fixed]);
    for (std::size_t k = 0; k < n; ++k) {
        for (std::size_t p = 0; p < PLACES; ++p) {
            rows_.allow(k, p, course.state(k, PLACE_PART[p]).b * (1 + ABOVE_LOWEST));
        }
    }
    SolveSettings settings;
    settings.objective = Objective::SPEED;
    settings.last_mu = last_mu;
    steps_ += law_.solve(fixed > 0 || before_ > 0 ? 2 : 0, 0, settings);
}

/// Makes the speed behind the fixed cells least, and eases limits of the speed that are lower.
void Profile::slow_down(std::size_t fixed) {
    make_slowest(fixed, cells() - fixed, LAST_MU);
    store(fixed);
    const Course course = course_from(fixed, &c_[fixed]);
    for (std::size_t k = 0; k < course.cells; ++k) {
        for (std::size_t p = 0; p < PLACES; ++p) {
            eased_[fixed + k][p] = course.state(k, PLACE_PART[p]).b * (1 + ABOVE_LOWEST);
        }
    }
}

void Profile::replan(const Run &run, std::size_t fixed) {
    take_limits(run);
    if (cells() > fixed && (fixed > 0 || before_ > 0)) {
        slow_down(fixed);
    }
    plan(run, fixed);
}

}  // namespace mw::trajectory::profile

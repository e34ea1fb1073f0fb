// SPDX-License-Identifier: GPL-2.0-or-later
#include "trajectory/profile/stop_search.hh"

#include <algorithm>
#include <cmath>

#include "trajectory/curve/curve_builder.hh"

namespace mw::trajectory::profile {

namespace {

/// TAIL_PLACES, SPAN_PLACES: number of points of a direct stop, and of points per span, at which limits are
/// checked. TAIL_ROUNDS: maximum number of attempts with reduced limits.
constexpr int TAIL_PLACES = 16;
constexpr double SPAN_PLACES = 12;
constexpr int TAIL_ROUNDS = 4;
/// Maximum time between these points [s].
constexpr double MOST_STEP_S = 2e-3;
/// Approximate number of points that are checked for a quick stop (0.2 ms).
constexpr std::size_t QUICK_PLACES = 400;
/// A stop is searched within this multiple of the length of a direct stop on a straight line.
constexpr double LENGTHS = 1.3;

bool isStraight(const Span &span) noexcept {
    for (std::size_t n = 2; n < span.c.size(); ++n) {
        if (std::ranges::any_of(span.c[n].c, [](double x) { return x != 0; })) {
            return false;
        }
    }
    return true;
}

/// True if limits do not change from `at` to the end of the span: the curve is straight, with one feed and no
/// seam nearby.
bool isPlain(const Run &run, const Span &span, std::size_t feed, const Motion &at) noexcept {
    if (run.joint_curve != nullptr || !isStraight(span) || (*run.feeds)[feed].end_s < span.end_s()) {
        return false;
    }
    return !run.hasCap(at.s, span.end_s());
}

}  // namespace

namespace {

/// Time to standstill with these limits [s].
double stop_time(double v, double a, double acceleration, double jerk) noexcept {
    // Speed of an equal stop that begins with acceleration 0.
    const double fall = std::max(v + 0.5 * a * std::abs(a) / jerk, 0.0);
    const double held = acceleration / jerk;
    return a / jerk + (fall > acceleration * held ? fall / acceleration + held : 2 * std::sqrt(fall / jerk));
}

}  // namespace

/// True if a direct stop is within all limits. Also reduces `least` to the remaining limits along it.
bool StopSearch::keepsLimits(const Course &course, std::size_t cell, const DirectStop &tail, Density density,
                             Rates &least) const {
    if (!(tail.end_s <= run_.end_s)) {
        return false;
    }
    const auto &spans = *run_.spans;
    const double duration = tail.duration();
    std::size_t span = span_at(spans, tail.cells[0].c[0]);
    std::size_t feed = run_.feed_at(tail.cells[0].c[0]);
    bool keeps = true;
    double phase_end = tail.cells[0].duration;
    std::size_t phase = 0;
    // The time of the maximum speed is one of the points.
    const double first_jerk = tail.jerk_at(0), first_a = tail.at(0).a;
    const double peak = first_a > 0 && first_jerk < 0 ? -first_a / first_jerk : 0.0;
    for (double t = 0, step = 0;;) {
        const Motion m = tail.at(t);
        while (span + 1 < spans.size() && m.s >= spans[span].end_s()) {
            ++span;
        }
        while (feed + 1 < run_.feeds->size() && m.s > (*run_.feeds)[feed].end_s) {
            ++feed;
        }
        ++places_;
        const CurvePoint point = curve::point_at(spans[span], m.s);
        const Rates left = rates_at(within_, point, m);
        least.acceleration = std::min(least.acceleration, left.acceleration);
        least.jerk = std::min(least.jerk, left.jerk);
        keeps = keeps && -m.a >= left.least - left.spare_acceleration &&
                -m.a <= left.acceleration + left.spare_acceleration &&
                std::abs(tail.jerk_at(t)) <= left.jerk + left.spare_jerk;
        // The speed may exceed a speed limit if the plan is at least as fast there.
        if (std::max(speed_share(within_, point, feed), left.speed_share) * m.v > 1) {
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
            step = std::min(step, to_end > fine && isPlain(within_, spans[span], feed, m) ? to_end : fine);
        }
        while (phase + 1 < DirectStop::PHASES && t >= phase_end) {
            phase_end += tail.cells[++phase].duration;
        }
        t = std::min({t + step, t < peak ? peak : duration, phase_end, duration});
    }
}

bool StopSearch::find(const Course &course, std::size_t cell, const Goal &goal, DirectStop &tail) const {
    const bool is_last = cell == course.cells;
    const std::size_t in = is_last ? cell - 1 : cell;
    const Motion from = plan_.motion_at(course, in, is_last ? 1 : 0);
    const std::size_t span = span_at(*run_.spans, from.s);
    Rates rates = rates_at(within_, curve::point_at((*run_.spans)[span], from.s), from);
    for (int round = 0; round < TAIL_ROUNDS; ++round) {
        const bool is_made = rates.acceleration > 0 && rates.jerk > 0 &&
                             (goal.end_s < ANYWHERE ? make_direct_stop_at(from, rates, goal.end_s, tail)
                                                    : make_direct_stop(from, rates, tail));
        if (!is_made || !(tail.duration() < goal.most_s)) {
            return false;
        }
        if (keepsLimits(course, in, tail, Density::COARSE, rates) &&
            keepsLimits(course, in, tail, Density::EVERY_SPAN, rates)) {
            return true;
        }
    }
    return false;
}

std::size_t StopSearch::first(const Course &course, std::size_t fixed, KnownStops &known,
                              DirectStop &tail) const {
    const std::size_t n = course.cells;
    std::size_t fails = 0, passes = n + 1;
    places_ = 0;
    const auto take = [&](std::size_t k) {
        const std::optional<DirectStop> *stop = known.get(fixed + k);
        if (stop == nullptr) {
            DirectStop found;
            known.set(fixed + k, find(course, k, {}, found) ? std::optional(found) : std::nullopt);
            stop = known.get(fixed + k);
        }
        if (*stop) {
            tail = **stop;
        }
        (*stop ? passes : fails) = k;
    };
    const auto isNear = [&] { return passes <= n && passes <= fails + 1 + passes / 8; };
    for (std::size_t k = 0, step = 1; passes > 0 && !isNear() && k <= n;) {
        take(k);
        const bool is_late = places_ > QUICK_PLACES;
        if (passes <= n && is_late) {
            break;
        }
        if (passes <= n) {
            k = (fails + passes) / 2;
        } else if (is_late && k < n) {
            k = n;  // the creep at the end
        } else {
            k = k == n ? n + 1 : std::min(k + step, n);
            step *= 2;
        }
    }
    return passes;
}

double StopSearch::least_s(const Course &course) const {
    const auto point_at = [&](double s) {
        return curve::point_at((*run_.spans)[span_at(*run_.spans, s)], s);
    };
    const Motion from = plan_.motion_at(course, 0, 0);
    if (!(from.v > 0)) {
        return 0;
    }
    const double jerk = rates_at(within_, point_at(from.s), {from.s, 0, 0}).jerk;
    double v2 = from.v * from.v, time_s = 0, s = from.s;
    for (std::size_t k = 0; k < course.cells && v2 > 0; ++k) {
        const double next = plan_.map.at(course.knots[k + 1]).s;
        const double v = std::sqrt(v2);
        const double brake = std::max(rates_at(within_, point_at(s), {s, v, 0}).acceleration, 0.0);
        const double left2 = std::max(v2 - 2 * brake * (next - s), 0.0);
        time_s += left2 > 0 ? 2 * (next - s) / (v + std::sqrt(left2)) : v / brake;
        v2 = left2;
        s = next;
    }
    return stop_time(from.v, from.a, (from.v - std::sqrt(v2)) / time_s, jerk);
}

std::size_t StopSearch::cells_of_stop(const Course &course) const {
    const Motion from = plan_.motion_at(course, 0, 0);
    const CurvePoint point = curve::point_at((*run_.spans)[span_at(*run_.spans, from.s)], from.s);
    const Rates rates = rates_at(within_, point, {from.s, 0, 0});
    const double reached = from.v + 0.5 * from.a * std::abs(from.a) / rates.jerk;
    const double ramp =
        std::max(rates.acceleration / rates.jerk, std::sqrt(std::max(reached, 0.0) / rates.jerk));
    const double length = LENGTHS * 0.5 * from.v * (from.v / rates.acceleration + ramp);
    std::size_t n = 1;
    while (n < course.cells && plan_.map.at(course.knots[n]).s < from.s + length) {
        ++n;
    }
    return n;
}

}  // namespace mw::trajectory::profile

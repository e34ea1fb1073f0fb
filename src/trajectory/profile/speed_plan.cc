// SPDX-License-Identifier: GPL-2.0-or-later
#include "trajectory/profile/speed_plan.hh"

#include <algorithm>
#include <cmath>

namespace mw::trajectory::profile {

LawState Course::state(std::size_t k, double x) const noexcept {
    const double h = knots[k + 1] - knots[k];
    const double h_before = k > 0 ? knots[k] - knots[k - 1] : before;
    const double h_behind = k + 1 < cells ? knots[k + 2] - knots[k + 1] : behind;
    const double slope = (c[k + 1] - c[k]) / (h_before + h);
    const double next = (c[k + 2] - c[k + 1]) / (h + h_behind);
    return {c[k + 1] - h * slope + h * ((2 * x - x * x) * slope + x * x * next), (1 - x) * slope + x * next,
            (next - slope) / h};
}

Course Course::first(std::size_t count) const noexcept {
    return {knots, c, count, before, count < cells ? knots[count + 1] - knots[count] : behind};
}

Course SpeedPlan::course_from(std::size_t fixed, const double *from) const noexcept {
    const double *k = &knots[fixed];
    return {k, from, laid() - fixed,
            fixed > 0    ? k[0] - k[-1]
            : before > 0 ? before
                         : k[1] - k[0],
            knots[laid()] - knots[laid() - 1]};
}

Motion SpeedPlan::motion_at(const Course &course, std::size_t cell, double x) const noexcept {
    const LawState state = course.state(cell, x);
    const MapPoint m = map.at(course.knots[cell] + x * (course.knots[cell + 1] - course.knots[cell]));
    return {m.s, m.first * std::sqrt(state.b), m.second * state.b + m.first * state.a};
}

/// The first cell is not longer than the last existing one. Each further cell is at most twice as long as the
/// one before.
void SpeedPlan::lay_first(double p) {
    const double from = knots.back(), h = from - knots[knots.size() - 2], length = p - from;
    double next = h, sum = h;
    int parts = 1;
    for (; sum < length; ++parts) {
        next *= 2;
        sum += next;
    }
    double end = h;
    for (int i = 1; i < parts; ++i) {
        knots.push_back(from + length * (end / sum));
        end = 2 * end + h;
    }
    knots.push_back(p);
}

/// The motion does not change.
void SpeedPlan::change_behind(double from, double to) noexcept {
    const std::size_t n = c.size() - 2;
    const double last = knots[n] - knots[n - 1];
    c[n + 1] = c[n] + (c[n + 1] - c[n]) * (last + to) / (last + from);
}

void SpeedPlan::cut(std::size_t kept) {
    const double behind = knots[kept + 1] - knots[kept];
    knots.resize(kept + 1);
    c.resize(kept + 2);
    eased.resize(kept);
    laid_s.resize(kept);
    change_behind(behind, knots[kept] - knots[kept - 1]);
    if (has_end) {
        has_end = false;
        map.take_end_away();
    }
}

void SpeedPlan::ease(std::size_t from, std::size_t to) {
    const Course course = course_from(0, c.data());
    for (std::size_t k = from; k < to; ++k) {
        for (std::size_t p = 0; p < PLACES; ++p) {
            eased[k][p] = course.state(k, PLACE_PART[p]).b * (1 + ABOVE_LOWEST);
        }
    }
}

void SpeedPlan::drop(std::size_t count) {
    before = knots[count] - knots[count - 1];
    const auto n = static_cast<long>(count);
    knots.erase(knots.begin(), knots.begin() + n);
    c.erase(c.begin(), c.begin() + n);
    eased.erase(eased.begin(), eased.begin() + n);
    laid_s.erase(laid_s.begin(), laid_s.begin() + n);
    speed_rows.erase(speed_rows.begin(), speed_rows.begin() + std::min<long>(n, std::ssize(speed_rows)));
    time_cells.erase(time_cells.begin(), time_cells.begin() + n);
}

bool SpeedPlan::takes_rows(const Rows &rows, std::size_t fixed, std::size_t old) {
    constexpr double HIGHER = 0.99;
    bool is_same = is_fastest && 2 * (old - std::min(fixed, old)) >= rows.cells();
    speed_rows.resize(laid());
    for (std::size_t k = fixed; k < laid(); ++k) {
        for (std::size_t p = 0; p < PLACES; ++p) {
            const double row = rows.velocity(k - fixed, p);
            is_same = is_same && (k >= old || row >= HIGHER * speed_rows[k][p]);
            speed_rows[k][p] = row;
        }
    }
    return is_same;
}

}  // namespace mw::trajectory::profile

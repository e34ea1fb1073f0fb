// SPDX-License-Identifier: GPL-2.0-or-later
#include "trajectory/profile/acceleration_profile.hh"

#include <algorithm>
#include <cmath>
#include <ranges>

namespace mw::trajectory::profile {

namespace {

/// Maximum time of a cell [s]. A new plan or a stop begins at the start of a cell.
constexpr double MOST_CELL_S = 2 * AccelerationCells::CELL_S;
/// Time of the first cell from standstill, in servo periods. So a stop that is requested in the first period
/// begins in the second.
constexpr double FIRST_CELL = 1.2;
/// Fractions by which the squared speed of a plan may exceed the squared speed from which a stop is possible:
/// by rounding, and within a cell.
constexpr double ROUNDING = 1e-6, WITHIN_CELL = 5e-3;

/// The motion with constant acceleration from a point to the squared speed `b` after `length`. Its duration
/// is 0 if the speed is 0 or the length is within rounding.
TimeCell cell_between(const MotionPoint &from, double b, double length) noexcept {
    constexpr double LEAST_CELL_S = 1e-12;
    const double v = std::sqrt(from.b), next = std::sqrt(std::max(b, 0.0));
    if (!(length > LEAST_CELL_S * (v + next))) {
        return {};
    }
    const double per_time = (v + next) / (2 * length);
    return {1 / per_time, {from.s, v, 0.5 * (next - v) * per_time, 0, 0, 0}};
}

}  // namespace

void AccelerationProfile::begin(double s) noexcept {
    start_s_ = end_s_ = s;
    is_complete_ = had_stop_ = false;
    time_cells_.clear();
    cells_.begin(s);
    joint_curve_.begin(nullptr, {});
}

void AccelerationProfile::take_limits(const Run &run) {
    run_ = run;
    run_.find_cap_reach();
    // A seam at the end of the known curve may lower limits before it. At a stop, there is no seam.
    if (had_stop_ && run.end_s != run_end_s_) {
        cells_.cut_behind(run_end_s_ - reach_);
    }
    const curve::CurvePoint end = curve::point_at((*run.spans)[span_at(*run.spans, run.end_s)], run.end_s);
    reach_ = largest_reach(end, run.limits, period_s_);
    run_end_s_ = run.end_s;
    had_stop_ = run.has_stop;
    // The interpolation of the joints is accurate to a fraction of a jerk limit.
    JointLimits accuracy = run.joints;
    for (std::size_t j = 0; j < static_cast<std::size_t>(accuracy.count); ++j) {
        accuracy.jerk[j] = accuracy.acceleration[j] / LEAST_RAMP_S;
    }
    run_.add_joints(joint_curve_, accuracy, time_cells_.empty() ? start_s_ : time_cells_[0].c[0]);
    drivable_end_s_ = run_.has_stop ? run_.end_s : run_.end_s - reach_;
    // Without jerk limits, the rows of a seam use the jerk that reaches full acceleration within one period.
    const auto set_jerk = [&](Bounds &b) { b.jerk = b.acceleration / period_s_; };
    for (std::size_t j = 0; j < joint_curve_.joints(); ++j) {
        run_.joints.jerk[j] = run_.joints.acceleration[j] / period_s_;
    }
    std::for_each(run_.limits.axes.begin(), run_.limits.axes.end(), set_jerk);
    set_jerk(run_.limits.xyz);
}

/// Squared speed limits at both ends of a cell. `feed`: feed at the start of this or an earlier cell; it is
/// updated.
AccelerationProfile::Ends AccelerationProfile::limited_b(std::size_t &feed,
                                                         const AccelerationCell &cell) const noexcept {
    constexpr double INSIDE = 1e-9;
    const auto &feeds = *run_.feeds;
    while (feed + 1 < feeds.size() && feeds[feed].end_s < cell.s + INSIDE * cell.length) {
        ++feed;
    }
    Ends out{cell.cap_b, cell.cap_b};
    for (std::size_t k = feed;; ++k) {
        const FeedLimit &f = feeds[k];
        for (std::size_t i = 0; i < out.size(); ++i) {
            const AccelerationCell::End &e = cell.ends[i];
            const double length2 = f.along == FeedLimit::Along::XYZ   ? e.xyz2
                                   : f.along == FeedLimit::Along::UVW ? e.uvw2
                                                                      : 1.0;
            out[i] = std::min(
                {out[i], square(f.velocity) / std::max(length2, 1e-30), square(f.limit_share) * e.machine_b});
            if (f.curve_share < 1 && !cell.is_straight) {
                out[i] = std::min(out[i], square(f.curve_share) * e.curve_b);
            }
        }
        if (k + 1 == feeds.size() || f.end_s >= cell.end_s() - INSIDE * cell.length) {
            return out;
        }
    }
}

/// Adds cells for the motion of the window with the following stop. They also cover a stop that begins now,
/// in case speed limits were lowered.
void AccelerationProfile::lay(const State &from, double time_s) {
    cells_.drop_before(from.s + rounding_at(from.s));
    speed_.clear();
    std::size_t feed = run_.feed_at(from.s);
    double t = 0, b = from.b, stopping_b = from.b;
    bool is_braking = false;
    if (cells_.size() == 0) {
        cells_.lay(run_, drivable_end_s_, b);
    }
    const bool is_inside = cells_.size() > 0 && cells_[0].end_s() >= drivable_end_s_;
    if (is_inside && from.b <= 0 && !cells_[0].is_straight) {
        cells_.divide(run_, from.s);
    }
    tail_at_ = 0;
    for (std::size_t k = 0;; ++k) {
        if (k == cells_.size()) {
            cells_.lay(run_, drivable_end_s_, b);
            if (k == cells_.size()) {
                return;
            }
        }
        if (k == 0) {
            head_ = cells_.part(run_, cells_[0], from.s, drivable_end_s_, AccelerationCells::Part::HEAD);
        }
        if (k > 0 && cells_[k].end_s() > drivable_end_s_) {
            tail_at_ = k;
            tail_ = cells_.part(run_, cells_[k], cells_[k].s, drivable_end_s_, AccelerationCells::Part::TAIL);
        }
        const AccelerationCell &cell = cell_at(k);
        speed_.push_back(limited_b(feed, cell));
        b = std::min({b, speed_[k][0], cell.most_b});
        double stop_s = 0;
        stopping_b = stopping_b > 0 ? brake(cell, stopping_b, stop_s) : 0.0;
        if (is_braking) {
            b = brake(cell, b, stop_s);
        } else {
            // The maximum speed without braking for the path after it.
            const double a = cell.is_straight ? cell.least : cells_.range(cell, b).high;
            const double next = std::clamp(b + 2 * a * cell.length, 0.0, speed_[k][1]);
            // In a straight cell it reaches the limit and stays there.
            const double rise = cell.is_straight
                                    ? std::clamp((next - b) / std::max(2 * a, 1e-300), 0.0, cell.length)
                                    : cell.length;
            const double v = std::sqrt(next);
            t += 2 * rise / std::max(std::sqrt(b) + v, 1e-12) + (cell.length - rise) / std::max(v, 1e-12);
            b = next;
            is_braking = t > time_s;
        }
        if ((is_braking && !(b > 0) && !(stopping_b > 0)) || cell.end_s() >= drivable_end_s_) {
            return;
        }
    }
}

/// The squared speed at the end of a cell with maximum braking. If the motion stops in the cell, it is 0, and
/// `stop_s` is the position.
double AccelerationProfile::brake(const AccelerationCell &cell, double b, double &stop_s) const noexcept {
    const double a = cell.is_straight ? -cell.least : cells_.lowest(cell, b);
    const double next = b + 2 * a * cell.length;
    if (next > 0) {
        return next;
    }
    // The limits at the end of the cell at standstill apply, too.
    const double within = cell.is_straight ? -cell.least : std::max(a, -cell.least);
    stop_s = std::min(cell.s - b / (2 * within), cell.end_s());
    return 0;
}

/// Calculates the maximum squared speed at the ends of the cells from which a stop is possible, within the
/// speed limits.
void AccelerationProfile::pass_backward() {
    const std::size_t n = speed_.size();
    most_.assign(n + 1, 0.0);
    for (std::size_t k = n; k-- > 0;) {
        const AccelerationCell &cell = cell_at(k);
        const double limit =
            std::min(cell.most_b, k > 0 ? std::min(speed_[k][0], speed_[k - 1][1]) : speed_[k][0]);
        const double most = std::max(limit, k < braked_.size() ? braked_[k] : 0.0);
        most_[k] = cell.is_straight ? std::min(most, most_[k + 1] + 2 * cell.least * cell.length)
                                    : cells_.most_before(cell, most, most_[k + 1]);
    }
}

/// The motion may exceed a lowered speed limit until maximum braking reaches it.
void AccelerationProfile::allow_braking(const State &from) {
    braked_.assign(1, from.b * (1 + ROUNDING));
    double b = from.b;
    for (std::size_t k = 0; k < speed_.size() && b > 0; ++k) {
        double stop_s = 0;
        b = brake(cell_at(k), b, stop_s);
        braked_.push_back(b * (1 + ROUNDING));
    }
}

/// Adds time cells with constant acceleration, from a point to the squared speed `b` after `length`.
void AccelerationProfile::add(const State &from, double b, double length) {
    const TimeCell whole = cell_between(from, b, length);
    if (!(whole.duration > 0)) {
        return;
    }
    const double v = whole.c[1], half_a = whole.c[2];
    const auto push = [&](double t, double duration) {
        time_cells_.push_back(
            {duration, {from.s + t * (v + half_a * t), v + 2 * half_a * t, half_a, 0, 0, 0}});
    };
    const double start = FIRST_CELL * period_s_, first = v > 0 || whole.duration < 2 * start ? 0.0 : start;
    if (first > 0) {
        push(0, first);
    }
    const int parts = static_cast<int>(std::max(std::ceil((whole.duration - first) / MOST_CELL_S), 1.0));
    const double part = (whole.duration - first) / parts;
    for (int i = 0; i < parts; ++i) {
        push(first + part * i, part);
    }
}

void AccelerationProfile::drive_straight(const AccelerationCell &cell, std::size_t k, State &from) {
    const double a2 = 2 * cell.least, length = cell.length, b = from.b;
    const double end = std::min(most_[k + 1], b + a2 * length);
    // The speed in between: the limit, or the speed that full acceleration reaches.
    const double limit = std::min(speed_[k][0], speed_[k][1]);
    const double top =
        b > limit ? std::max(limit, std::min(end, b)) : std::min(limit, 0.5 * (b + end + a2 * length));
    const double first = std::min(std::abs(top - b) / a2, length);
    const double last = std::min(std::abs(top - end) / a2, length - first);
    add(from, top, first);
    add({cell.s + first, top}, top, length - first - last);
    add({cell.end_s() - last, top}, end, last);
    from = {cell.end_s(), end};
}

void AccelerationProfile::drive(const AccelerationCell &cell, std::size_t k, State &from) {
    if (cell.is_straight) {
        drive_straight(cell, k, from);
        return;
    }
    const double end =
        std::clamp(from.b + 2 * cell.length * cells_.range(cell, from.b).high, 0.0, most_[k + 1]);
    add(from, end, cell.length);
    from = {cell.end_s(), end};
}

/// Returns the time of the motion to the end of the cells or of the window [s].
double AccelerationProfile::pass_forward(State from) {
    const double to = run_.has_stop ? run_.end_s : 1e300;
    double t = 0;
    for (std::size_t k = 0; k < speed_.size() && t < window_s_; ++k) {
        const std::size_t old = time_cells_.size();
        drive(cell_at(k), k, from);
        for (std::size_t i = old; i < time_cells_.size(); ++i) {
            t += time_cells_[i].duration;
        }
        if (time_cells_.size() == old) {
            break;  // the speed is 0
        }
    }
    end_s_ = from.s;
    is_complete_ = from.b <= 0 && from.s >= to - rounding_at(to);
    return t;
}

bool AccelerationProfile::plan(const Run &run, std::size_t fixed) {
    constexpr double FARTHER = 1.5;
    if (fixed >= time_cells_.size() && !time_cells_.empty()) {
        return true;
    }
    const State from = state_at(fixed);
    take_limits(run);
    if (!(drivable_end_s_ > from.s)) {
        return true;
    }
    std::size_t laid = 0;
    for (double time_s = window_s_;; time_s *= FARTHER) {
        lay(from, time_s);
        if (speed_.empty()) {
            return true;  // the joints cannot reach the path ahead
        }
        const bool is_farthest = speed_.size() == laid;
        laid = speed_.size();
        braked_.clear();
        pass_backward();
        if (from.b > most_[0] * (1 + ROUNDING)) {
            allow_braking(from);
            pass_backward();
        }
        if (from.b > most_[0] * (1 + WITHIN_CELL)) {
            return is_complete_ && end_s_ <= drivable_end_s_ ? true : stop_soon(from, fixed);
        }
        time_cells_.resize(fixed);
        const double laid_end_s = cell_at(speed_.size() - 1).end_s();
        const bool is_all = laid_end_s >= drivable_end_s_;
        // A stop at the end of the cells is behind the window.
        const bool is_full = pass_forward(from) >= window_s_ && end_s_ < laid_end_s;
        if (is_full || is_all || is_farthest) {
            return true;
        }
    }
}

/// If the end is nearer than the plan may stop, the plan ends with the soonest stop. False if this stop ends
/// after the end of the curve.
bool AccelerationProfile::stop_soon(const State &from, std::size_t fixed) {
    const Stop stop = stop_from(from);
    if (stop.cells.empty() || stop.end_s > drivable_end_s_) {
        return false;
    }
    time_cells_.resize(fixed);
    for (std::size_t k = 0; k < stop.cells.size(); ++k) {
        const TimeCell &cell = stop.cells[k];
        const bool is_last = k + 1 == stop.cells.size();
        const double to = is_last ? stop.end_s : stop.cells[k + 1].c[0];
        add({cell.c[0], square(cell.c[1])}, is_last ? 0 : square(stop.cells[k + 1].c[1]), to - cell.c[0]);
    }
    end_s_ = stop.end_s;
    is_complete_ = true;
    return true;
}

Stop AccelerationProfile::stop_from(const State &start) {
    Stop out;
    out.cells.reserve(speed_.size());
    State from = start;
    const auto indices = std::views::iota(std::size_t{0}, speed_.size() - 1);
    std::size_t k =
        *std::ranges::partition_point(indices, [&](std::size_t i) { return cell_at(i).end_s() <= from.s; });
    const AccelerationCell *cell = &cell_at(k);
    AccelerationCell part;
    if (from.s > cell->s) {
        part = cells_.part(run_, *cell, from.s, cell->end_s(), AccelerationCells::Part::STOP);
        cell = &part;
    }
    while (true) {
        double stop_s = cell->end_s();
        double b = brake(*cell, from.b, stop_s);
        // If the plan itself stops at the end of the known curve, this stop also ends there, except for
        // rounding.
        const bool is_last = k + 1 == speed_.size();
        if (is_last && b <= ROUNDING * start.b) {
            b = 0;
        }
        const double to = b > 0 ? cell->end_s() : stop_s;
        const TimeCell motion = cell_between(from, b, to - from.s);
        if (motion.duration > 0) {
            out.cells.push_back(motion);
        }
        from = {to, b};
        if (!(b > 0)) {
            break;
        }
        if (is_last) {
            return {};  // the stop does not end on the known curve
        }
        cell = &cell_at(++k);
    }
    out.end_s = from.s;
    return out;
}

/// The motion at the start of a time cell, or at the end of the last one.
AccelerationProfile::State AccelerationProfile::state_at(std::size_t cell) const noexcept {
    if (time_cells_.empty()) {
        return {start_s_, 0};
    }
    if (cell < time_cells_.size()) {
        return {time_cells_[cell].c[0], square(time_cells_[cell].c[1])};
    }
    const TimeCell &last = time_cells_.back();
    return {end_s_, is_complete_ ? 0.0 : square(last.v_at(last.duration))};
}

Stop AccelerationProfile::next_stop(const Run &, std::size_t fixed, StopEffort) {
    const State from = state_at(fixed);
    if (!(from.b > 0) || speed_.empty()) {
        return {std::min(fixed, cells()), {}, from.s};
    }
    Stop stop = stop_from(from);
    stop.kept = std::min(fixed, cells());
    return stop.cells.empty() ? Stop{cells(), {}, end_s()} : stop;
}

void AccelerationProfile::drop(std::size_t count) {
    time_cells_.erase(time_cells_.begin(), time_cells_.begin() + static_cast<long>(count));
}

}  // namespace mw::trajectory::profile

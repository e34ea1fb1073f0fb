// SPDX-License-Identifier: GPL-2.0-or-later
#include "trajectory/profile/acceleration_cells.hh"

#include <algorithm>
#include <cmath>

namespace mw::trajectory::profile {

namespace {

using Norm = PointLimits::Norm;

constexpr double LEAST = 1e-30;
/// Maximum number of cells of equal length between two points where a formula changes.
constexpr double MOST_CELLS = 32;
/// Minimum time of a cell [s]. Shorter cells are not made by division.
constexpr double LEAST_CELL_S = 1e-4;
/// A cell counts as straight if, at maximum speed, its curvature uses less than this fraction of every
/// acceleration limit.
constexpr double STRAIGHT = 1e-6;
/// Fractions of the limits used for planning. On a curve, the motion may exceed these between the ends of a
/// cell.
constexpr double CURVE_ACCELERATION = 1 - AccelerationCells::BETWEEN, STRAIGHT_ACCELERATION = 1 - STRAIGHT;
constexpr double CURVE_VELOCITY = 0.999;

/// The norm divided by a fraction of its limit.
Norm within(const Norm &n, double share) noexcept {
    const double scale = 1 / square(share);
    return {scale * n.aa, scale * n.ab, scale * n.bb};
}

/// The norm at the distance h after the start of a cell, as a function of the squared speed at the start.
Norm by_start(const Norm &n, double h) noexcept {
    return {n.aa + 4 * h * (n.ab + h * n.bb), n.ab + 2 * h * n.bb, n.bb};
}

/// Squared speed above which no acceleration keeps the norm within its limit.
double most_of(const Norm &n) noexcept {
    const double d = n.aa * n.bb - n.ab * n.ab;
    return d > 0 ? std::sqrt(n.aa / d) : 1e300;
}

void take_norm(const Norm &n, double b, AccelerationRange &range) noexcept {
    if (!(n.aa > LEAST)) {
        return;
    }
    const double d = n.ab * n.ab - n.aa * n.bb;
    const double root = std::sqrt(std::max(d * b * b + n.aa, 0.0));
    const double slope = d * b / std::max(root, LEAST);
    const double high = (root - n.ab * b) / n.aa, low = (-root - n.ab * b) / n.aa;
    if (high < range.high) {
        range.high = high;
        range.high_slope = (slope - n.ab) / n.aa;
    }
    if (low > range.low) {
        range.low = low;
        range.low_slope = (-slope - n.ab) / n.aa;
    }
}

}  // namespace

void AccelerationCells::begin(double s) noexcept {
    begin_s_ = s;
    stretch_.end_s = NO_STRETCH;
    cells_.clear();
    rows_.clear();
    first_row_ = 0;
}

void AccelerationCells::drop_before(double s) {
    const auto left = std::partition_point(cells_.begin(), cells_.end(),
                                           [&](const AccelerationCell &c) { return c.end_s() <= s; });
    if (left == cells_.begin()) {
        return;
    }
    begin_s_ = (left - 1)->end_s();
    cells_.erase(cells_.begin(), left);
    const std::size_t row = cells_.empty() ? first_row_ + rows_.size() : cells_.front().row;
    rows_.erase(rows_.begin(), rows_.begin() + static_cast<long>(row - first_row_));
    first_row_ = row;
}

void AccelerationCells::cut_behind(double s) {
    while (!cells_.empty() && cells_.back().end_s() > s) {
        rows_.resize(cells_.back().row - first_row_);
        begin_s_ = cells_.back().s;
        stretch_.end_s = NO_STRETCH;
        cells_.pop_back();
    }
}

/// Makes the cell from `from` to `to`. `limits`: limits at two points; `at`: their distances from the start
/// of the cell.
AccelerationCell AccelerationCells::make(double from, double to, const std::array<PointLimits, 2> &limits,
                                         const std::array<double, 2> &at, bool is_straight,
                                         std::vector<Row> &rows) {
    AccelerationCell cell;
    cell.s = from;
    cell.length = to - from;
    cell.is_straight = is_straight;
    const double share = is_straight ? STRAIGHT_ACCELERATION : CURVE_ACCELERATION;
    const double velocity2 = is_straight ? 1.0 : square(CURVE_VELOCITY);
    cell.least = 1e300;
    for (std::size_t e = 0; e < limits.size(); ++e) {
        const PointLimits &d = limits[e];
        for (std::size_t i = 0; i < d.count; ++i) {
            const double m = d.q1[i] + 2 * at[e] * d.q2[i];
            const double per = 1 / (std::abs(m) > LEAST ? m : LEAST);
            rows.push_back({d.q2[i] * per, share * std::abs(per)});
        }
        cell.rows += d.count;
        cell.ends[e] = {velocity2 * d.machine_b, share * d.curve_b, d.xyz2, d.uvw2};
        cell.norms[e] = by_start(within(d.norm, share), at[e]);
        cell.has_norm = cell.has_norm || d.norm.aa > LEAST;
        cell.least = std::min(cell.least, share * d.least());
    }
    return cell;
}

/// The next point after the last cell where a formula changes: the end of a span or of a part of the joints,
/// a change of the feed, the reach of a seam.
double AccelerationCells::next_point(const Run &run, const Span &span, double end) const noexcept {
    const double s = end_s(), rounding = rounding_at(s);
    double next = std::min(span.end_s(), end);
    const auto take = [&](double point) {
        next = point > s + rounding && point < next - rounding ? point : next;
    };
    const auto &feeds = *run.feeds;
    for (std::size_t k = run.feed_at(s + rounding); k + 1 < feeds.size() && feeds[k].end_s < next - rounding;
         ++k) {
        const FeedLimit &a = feeds[k], &b = feeds[k + 1];
        if (a.velocity != b.velocity || a.along != b.along || a.limit_share != b.limit_share ||
            a.curve_share != b.curve_share) {
            take(a.end_s);
        }
    }
    if (run.joint_curve != nullptr) {
        take(run.joint_curve->parts()[run.joint_curve->part_at(s + rounding)].end_s());
    }
    run.each_cap(s, next, [&](const SpeedCap &cap) {
        take(cap.s - cap.reach);
        take(cap.s);
        take(cap.s + cap.reach);
    });
    return next;
}

void AccelerationCells::begin_stretch(const Run &run, double end) {
    const double s = end_s();
    const Span &span = (*run.spans)[span_at(*run.spans, s + rounding_at(s))];
    const double to = next_point(run, span, end), length = to - s;
    stretch_.end_s = to;
    if (!(length > 0)) {
        return;
    }
    // A seam whose reach ends at the start of the stretch is not taken into account.
    const double rounding = std::min(2 * rounding_at(to), 0.25 * length);
    stretch_.rest = rest_of(run, s + rounding, to - rounding);
    stretch_.place = place_at(run, s + 0.5 * length);
    std::array<PointLimits, 3> at;
    double straight = 0, change = 0, fastest_b = 0, acceleration = 1e300;
    for (std::size_t i = 0; i < at.size(); ++i) {
        PointLimits &d = at[i];
        find_limits(run, stretch_.place, s + 0.5 * length * static_cast<double>(i), stretch_.rest, d);
        const double b = std::min(d.curve_b, d.machine_b);
        straight = std::max(straight, d.bend() * d.machine_b);
        fastest_b = std::max(fastest_b, b);
        acceleration = std::min(acceleration, d.least());
        change = std::max(change, change_between(at[i > 0 ? i - 1 : 0], d, 0.5 * length, {b, d.least()}));
    }
    stretch_.is_straight = straight < STRAIGHT;
    stretch_.acceleration = acceleration;
    const double most = std::max(1.0, length / (LEAST_CELL_S * std::sqrt(fastest_b)));
    const double count =
        std::clamp(std::ceil(length * std::sqrt(change / (8 * BETWEEN))), 1.0, std::min(most, MOST_CELLS));
    stretch_.cell = stretch_.is_straight ? length : length / count;
    stretch_.end = at[0];
}

/// Bound of the change of the limits between the ends of the cell, for every motion up to its `most_b`,
/// divided by the permitted change.
double AccelerationCells::change_in(const AccelerationCell &cell, const PointLimits &start,
                                    const PointLimits &end) const noexcept {
    const AccelerationRange slow = range(cell, 0), fast = range(cell, cell.most_b);
    const double a = std::max({slow.high, -slow.low, std::abs(fast.high), std::abs(fast.low)});
    const PathMotion most{cell.most_b, std::min(a, cell.most_b / (2 * cell.length))};
    return square(cell.length) * change_between(start, end, cell.length, most) / (8 * BETWEEN);
}

/// Adds cells up to `to`: one cell, or several if the limits change too much within it. If the parts would
/// take less than LEAST_CELL_S, the speed is limited instead.
void AccelerationCells::add(const Run &run, double to) {
    constexpr double SLOWER = 0.7, LEAST_B = 1e-12;
    const double from = end_s();
    PointLimits end;
    find_limits(run, stretch_.place, to, stretch_.rest, end);
    const std::size_t row = first_row_ + rows_.size();
    AccelerationCell cell = make(from, to, {stretch_.end, end}, {0, to - from}, stretch_.is_straight, rows_);
    cell.row = row;
    cell.cap_b = stretch_.rest.v2 > 0 ? 1 / stretch_.rest.v2 : 1e300;
    if (!cell.is_straight) {
        cell.most_b = most_before(cell, std::min(cell.ends[0].machine_b, cell.ends[1].machine_b), 1e300);
        while (cell.most_b > LEAST_B && change_in(cell, stretch_.end, end) > 1) {
            if (cell.length > 2 * LEAST_CELL_S * std::sqrt(cell.most_b)) {
                rows_.resize(row - first_row_);
                add(run, 0.5 * (from + to));
                add(run, to);
                return;
            }
            cell.most_b *= SLOWER;
        }
    }
    cells_.push_back(cell);
    stretch_.end = end;
}

void AccelerationCells::lay(const Run &run, double end, double b) {
    const double s = end_s();
    if (!(stretch_.end_s > s + rounding_at(s) && stretch_.end_s <= end)) {
        begin_stretch(run, end);
    }
    const double left = stretch_.end_s - s;
    if (!(left > 0)) {
        return;
    }
    stretch_.place = place_at(run, s + 0.5 * left);  // earlier spans may have been dropped
    double longest = stretch_.cell;
    if (!stretch_.is_straight) {
        const double a = stretch_.acceleration;
        const double to_stop = run.has_stop ? 2 * a * (end - s) : 1e300;
        longest = std::min(longest, CELL_S * (std::sqrt(std::min(b, to_stop)) + 0.5 * CELL_S * a));
    }
    constexpr double ROUNDING = 1e-9;
    const double parts = std::ceil(left / longest * (1 - ROUNDING));

    add(run, parts > 1 ? s + left / parts : stretch_.end_s);
}

void AccelerationCells::divide(const Run &run, double s) {
    constexpr int PARTS = 16;
    const double end = cells_[0].end_s();
    begin(s);
    begin_stretch(run, end);
    for (int i = 1; i <= PARTS; ++i) {
        add(run, i == PARTS ? end : s + (end - s) * i / PARTS);
    }
}

AccelerationCell AccelerationCells::part(const Run &run, const AccelerationCell &cell, double s, double end,
                                         Part which) {
    const auto slot = static_cast<std::size_t>(which);
    std::vector<Row> &rows = part_rows_[slot];
    rows.clear();
    const double to = std::min(end, cell.end_s()), middle = cell.s + 0.5 * cell.length;
    const CapRest rest = rest_of(run, middle, middle);
    const CurvePlace place = place_at(run, middle);
    std::array<PointLimits, 2> limits;
    find_limits(run, place, cell.s, rest, limits[0]);
    find_limits(run, place, to, rest, limits[1]);
    AccelerationCell out = make(s, to, limits, {cell.s - s, to - s}, cell.is_straight, rows);
    out.row = IN_PART + slot;
    out.most_b = cell.most_b;
    out.cap_b = cell.cap_b;
    return out;
}

AccelerationRange AccelerationCells::range(const AccelerationCell &cell, double b) const noexcept {
    AccelerationRange range;
    const Row *rows = rows_of(cell);
    for (std::size_t i = 0; i < cell.rows; ++i) {
        const double at = rows[i].c * b;
        const double high = rows[i].r - at, low = -rows[i].r - at;
        if (high < range.high) {
            range.high = high;
            range.high_slope = -rows[i].c;
        }
        if (low > range.low) {
            range.low = low;
            range.low_slope = -rows[i].c;
        }
    }
    if (cell.has_norm) {
        take_norm(cell.norms[0], b, range);
        take_norm(cell.norms[1], b, range);
    }
    return range;
}

double AccelerationCells::lowest(const AccelerationCell &cell, double b) const noexcept {
    double low = -1e300;
    const Row *rows = rows_of(cell);
    for (std::size_t i = 0; i < cell.rows; ++i) {
        low = std::max(low, -rows[i].r - rows[i].c * b);
    }
    for (const Norm &n : cell.norms) {
        if (n.aa > LEAST) {
            low = std::max(
                low,
                -(std::sqrt(std::max((n.ab * n.ab - n.aa * n.bb) * b * b + n.aa, 0.0)) + n.ab * b) / n.aa);
        }
    }
    return low;
}

double AccelerationCells::most_before(const AccelerationCell &cell, double most, double next) const noexcept {
    // The range between the lower and the upper bound of the acceleration is concave in b. So Newton's method
    // from above finds its zero without passing it.
    constexpr int MOST_STEPS = 40;
    constexpr double ROUNDING = 1e-9;
    const double per = 1 / (2 * cell.length);
    double b = most;
    if (cell.has_norm) {
        b = std::min({b, most_of(cell.norms[0]), most_of(cell.norms[1])});
    }
    for (int n = 0; n < MOST_STEPS; ++n) {
        AccelerationRange range = this->range(cell, b);
        if ((next - b) * per < range.high) {
            range.high = (next - b) * per;
            range.high_slope = -per;
        }
        if (-b * per > range.low) {
            range.low = -b * per;
            range.low_slope = -per;
        }
        const double gap = range.high - range.low;
        if (gap >= -ROUNDING * (std::abs(range.high) + std::abs(range.low))) {
            return b;
        }
        const double slope = range.high_slope - range.low_slope;
        const double lower = slope < 0 ? b - gap / slope : 0.5 * b;
        b = lower > 0 && lower < b ? lower : 0.5 * b;
    }
    return b;
}

}  // namespace mw::trajectory::profile

// SPDX-License-Identifier: GPL-2.0-or-later
#include "trajectory/curve/curve_builder.hh"

#include <algorithm>
#include <cmath>
#include <span>

namespace mw::trajectory::curve {

namespace {

/// Deviation of a curve at a corner, divided by the change of the tangent and the knot spacing, for uniform
/// knots. It is only the first estimate: spacings that are too large are reduced.
constexpr double CORNER_DEVIATION = 28.0 / 120.0;
/// Length of path that a control point averages, divided by the knot spacing.
constexpr double MEAN_WIDTH = 1.5;
constexpr int MAX_ROUNDS = 60;
/// Fraction of the tolerance by which the bound of the deviation may exceed the deviation.
constexpr double BOUND_SLACK = 0.02;
constexpr double MAX_PARTS = 16;
/// A corner gets a knot at its vertex if the last such knot is at least this many spacings away.
constexpr double APART = 3.0;
/// KNOTS_BEFORE: number of knots before the first open span on which its control points depend. KNOTS_BEHIND:
/// number of knots after the last final span on which its control points depend. A control point depends on
/// its neighbours, and their averages extend to their own neighbours.
constexpr std::size_t KNOTS_BEFORE = DEGREE + 1, KNOTS_BEHIND = DEGREE + 2;
/// Minimum spacing [unit]. It bounds the number of knots for every tolerance.
constexpr double LEAST_SPACING = 1e-6;

double larger_norm(const Pose &p) noexcept {
    return std::max(geometry::norm_linear(p), geometry::norm_abc(p));
}

}  // namespace

CurveBuilder::CurveBuilder(double widest) : widest_(widest) {
    begin();
}

Room CurveBuilder::endless() noexcept {
    Room room;
    room.low.c.fill(-1e300);
    room.high.c.fill(1e300);
    return room;
}

void CurveBuilder::set_room(Room room) noexcept {
    next_room_ = std::move(room);
}

void CurveBuilder::begin(double s) noexcept {
    start_s_ = s;
    room_ = next_room_;
    path_.clear(s);
    caps_.assign(1, {s, widest_, true});
    knots_.assign(1, s);
    spans_.clear();
    open_.clear();
    last_fit_ = {};
    fixed_ = 1;
    first_open_ = 0;
    final_worst_ = 0;
    rounds_ = 0;
}

bool CurveBuilder::add(const Primitive &primitive, double tolerance) {
    if (!(tolerance > 0) || !(primitive.length > 0)) {
        return false;
    }
    if (!path_.moves().empty()) {
        const ProgrammedMove &last = path_.moves().back();
        const Pose step = derivative_at(primitive, 0) - derivative_at(last.primitive, last.primitive.length);
        const double turn = std::max(larger_norm(step), 1e-12);
        const double spacing = std::min(tolerance, last.tolerance) / (CORNER_DEVIATION * turn);
        if (spacing < widest_) {
            caps_.push_back({path_.length(), std::max(spacing, LEAST_SPACING), true});
        }
    }
    path_.add(primitive, tolerance);
    return true;
}

void CurveBuilder::extend(bool complete) {
    if (path_.moves().empty() || path_.length() <= knots_[fixed_ - 1]) {
        return;
    }
    for (int round = 0; round < MAX_ROUNDS; ++round) {
        ++rounds_;
        spread_caps();
        lay_knots();
        place_controls();
        make_spans();
        if (check()) {
            break;
        }
        caps_.insert(caps_.end(), found_.begin(), found_.end());
        std::sort(caps_.begin(), caps_.end(), [](const Cap &a, const Cap &b) { return a.s < b.s; });
    }
    keep_final(complete);
}

void CurveBuilder::spread_caps() {
    envelope_.resize(caps_.size());
    for (std::size_t i = 0; i < caps_.size(); ++i) {
        const double reach =
            i == 0 ? widest_ : envelope_[i - 1] + SPACING_GROWTH * (caps_[i].s - caps_[i - 1].s);
        envelope_[i] = std::min(reach, caps_[i].spacing);
    }
    for (std::size_t i = caps_.size(); i-- > 1;) {
        envelope_[i - 1] =
            std::min(envelope_[i - 1], envelope_[i] + SPACING_GROWTH * (caps_[i].s - caps_[i - 1].s));
    }
}

double CurveBuilder::spacing_at(double s, std::size_t &cap) const noexcept {
    while (cap + 1 < caps_.size() && s >= caps_[cap + 1].s) {
        ++cap;
    }
    const double behind =
        cap + 1 < caps_.size() ? envelope_[cap + 1] + SPACING_GROWTH * (caps_[cap + 1].s - s) : widest_;
    return std::min({widest_, envelope_[cap] + SPACING_GROWTH * std::abs(s - caps_[cap].s), behind});
}

void CurveBuilder::lay_between(double from, double to, std::size_t cap) {
    const std::size_t first = knots_.size();
    double s = from;
    while (s < to) {
        // The spacing is evaluated half a step ahead, so the knots are the same in both directions.
        const double near = spacing_at(s, cap);
        std::size_t ahead = cap;
        s += spacing_at(std::min(s + 0.5 * near, to), ahead);
        knots_.push_back(s);
    }
    if (knots_.size() > first + 1 && s - to > to - knots_[knots_.size() - 2]) {
        knots_.pop_back();
        s = knots_.back();
    }
    const double scale = (to - from) / (s - from);
    for (std::size_t i = first; i < knots_.size(); ++i) {
        knots_[i] = from + (knots_[i] - from) * scale;
    }
    knots_.back() = to;
}

void CurveBuilder::lay_knots() {
    knots_.resize(fixed_);
    const double length = path_.length();
    std::size_t cap = 0;
    while (cap + 1 < caps_.size() && caps_[cap + 1].s <= knots_.back()) {
        ++cap;
    }
    for (std::size_t i = cap + 1; i < caps_.size(); ++i) {
        const bool is_least = caps_[i].is_corner && envelope_[i] == caps_[i].spacing;
        const double need = APART * caps_[i].spacing;
        if (is_least && caps_[i].s - knots_.back() > need && length - caps_[i].s > need) {
            lay_between(knots_.back(), caps_[i].s, cap);
            cap = i;
        }
    }
    lay_between(knots_.back(), length, cap);
}

void CurveBuilder::place_controls() {
    const KnotRow row(knots_);
    const std::size_t n = row.controls();
    // The first open span needs its own control points and the two adjacent ones.
    const std::size_t from = first_open_ == 0 ? 0 : first_open_ - 1;
    places_.resize(n);
    means_.resize(n);
    controls_.resize(n);
    for (std::size_t i = from == 0 ? 0 : from - 1; i < n; ++i) {
        places_[i] = row.greville(i);
    }
    const auto width = [&](std::size_t i) {
        return i == 0 || i + 1 == n
                   ? 0.0
                   : MEAN_WIDTH * std::min(places_[i + 1] - places_[i], places_[i] - places_[i - 1]);
    };
    std::size_t move = 0;
    for (std::size_t i = from; i < n; ++i) {
        const double reach = 0.5 * width(i);
        move = path_.move_at(places_[i] - reach, move);
        means_[i] = path_.mean(move, places_[i] - reach, places_[i] + reach);
    }
    for (std::size_t i = first_open_; i < n; ++i) {
        controls_[i] = means_[i];
        if (i > 0 && i + 1 < n) {
            const double before = places_[i] - places_[i - 1], behind = places_[i + 1] - places_[i];
            const Pose second =
                ((means_[i + 1] - means_[i]) * (1 / behind) - (means_[i] - means_[i - 1]) * (1 / before)) *
                (2 / (before + behind));
            const double w = width(i);
            const Pose control = means_[i] + second * (0.5 * (row.curvature_shift(i) - w * w / 12));
            controls_[i] = kept_in_room(control, means_[i]);
        }
    }
}

/// True if span k depends on the same knots as span `of_fit` of the fit.
bool CurveBuilder::hasSameKnots(std::size_t k, const Fit &fit, std::size_t of_fit) const noexcept {
    const auto knots = [](const std::vector<double> &all, std::size_t span) {
        const std::size_t from = span > KNOTS_BEFORE ? span - KNOTS_BEFORE : 0;
        const std::size_t to = std::min(span + KNOTS_BEHIND + 2, all.size());
        return std::span(all).subspan(from, to - from);
    };
    // At an end of the knot row, a span depends on fewer knots.
    return (k < KNOTS_BEFORE ? k == of_fit : of_fit >= KNOTS_BEFORE) &&
           std::ranges::equal(knots(knots_, k), knots(fit.knots, of_fit));
}

void CurveBuilder::make_spans() {
    std::swap(open_, last_fit_.spans);
    open_.clear();
    const std::size_t count = knots_.size() - 1;
    std::size_t old = 0;
    for (std::size_t k = first_open_; k < count; ++k) {
        while (old < last_fit_.spans.size() && last_fit_.spans[old].span.start_s < knots_[k]) {
            ++old;
        }
        if (old < last_fit_.spans.size() && hasSameKnots(k, last_fit_, last_fit_.first + old)) {
            open_.push_back(last_fit_.spans[old]);
        } else {
            open_.push_back({span_of(k)});
        }
    }
    last_fit_.knots = knots_;
    last_fit_.first = first_open_;
}

/// The weights of a B-spline are not negative and add up to 1. So each coordinate of the curve lies between
/// the minimum and the maximum of its control points, and so does a joint in proportion to them. The average
/// of a path within the limits is within the limits.
Pose CurveBuilder::kept_in_room(const Pose &control, const Pose &mean) const noexcept {
    Pose kept;
    for (std::size_t i = 0; i < geometry::AXIS_COUNT; ++i) {
        kept.c[i] = std::clamp(control.c[i], std::min(room_.low.c[i], mean.c[i]),
                               std::max(room_.high.c[i], mean.c[i]));
    }
    double part = 1;
    for (const Room::Row &row : room_.rows) {
        const double from = geometry::dot(row.slope, mean), travel = geometry::dot(row.slope, kept) - from;
        const double room = travel > 0 ? std::max(row.high - from, 0.0) : std::max(from - row.low, 0.0);
        part = std::abs(travel) > room ? std::min(part, room / std::abs(travel)) : part;
    }
    return part < 1 ? mean + (kept - mean) * part : kept;
}

Span CurveBuilder::span_of(std::size_t k) const noexcept {
    Span span;
    span.start_s = knots_[k];
    span.length = knots_[k + 1] - knots_[k];
    KnotRow::Weights w;
    KnotRow(knots_).weights(k, w);
    // Differences to `base` keep a coordinate that does not move constant to the last digit.
    const Pose &base = controls_[k];
    span.c[0] = base;
    for (std::size_t n = 0; n < COEFFICIENTS; ++n) {
        for (std::size_t j = 0; j < COEFFICIENTS; ++j) {
            for (std::size_t i = 0; i < geometry::AXIS_COUNT; ++i) {
                span.c[n].c[i] += w[n][j] * (controls_[k + j].c[i] - base.c[i]);
            }
        }
    }
    span.find_moving();
    return span;
}

/// At a corner, the deviation is proportional to the spacing, on a curve to its square.
void CurveBuilder::narrow(double s, double excess, double length) {
    const auto behind =
        std::upper_bound(caps_.begin(), caps_.end(), s, [](double x, const Cap &c) { return x < c.s; });
    std::size_t before = static_cast<std::size_t>(std::max<long>(0, behind - caps_.begin() - 1));
    const double spacing = std::min(spacing_at(s, before), length);
    std::size_t nearest = caps_.size();
    double least = 1.5 * spacing;
    for (const std::size_t i : {before, before + 1}) {
        if (i < caps_.size() && std::abs(caps_[i].s - s) < least) {
            least = std::abs(caps_[i].s - s);
            nearest = i;
        }
    }
    constexpr double MOST = 0.3;
    constexpr double MORE = 0.99;
    if (nearest < caps_.size()) {
        Cap &cap = caps_[nearest];
        const double share = MORE / (cap.is_corner ? excess : std::sqrt(excess));
        cap.spacing = std::max(std::min(cap.spacing, spacing) * std::max(share, MOST), LEAST_SPACING);
        is_narrowed_ = true;
    } else {
        found_.push_back(
            {s, std::max(spacing * std::max(MOST, MORE / std::sqrt(excess)), LEAST_SPACING), false});
    }
}

/// Returns the deviation divided by the tolerance. If it exceeds 1, the knot spacing is reduced there.
double CurveBuilder::check_span(const Span &span, std::size_t &move) {
    // The Bernstein coefficients of the second derivative give its bound. Between two points, the deviation
    // exceeds the larger of both by at most an eighth of this bound times the square of their distance.
    const double per2 = 1.0 / (span.length * span.length);
    const Pose d0 = span.c[2] * (2 * per2), d1 = span.c[3] * (6 * per2), d2 = span.c[4] * (12 * per2),
               d3 = span.c[5] * (20 * per2);
    const double bend =
        std::max({larger_norm(d0), larger_norm(d0 + d1 * (1.0 / 3)),
                  larger_norm(d0 + d1 * (2.0 / 3) + d2 * (1.0 / 3)), larger_norm(d0 + d1 + d2 + d3)});
    double worst = 0, worst_s = span.start_s;
    move = path_.move_at(span.start_s, move);
    for (double s = span.start_s; s < span.end_s();) {
        const ProgrammedMove &m = path_.moves()[move];
        const bool is_last = move + 1 == path_.moves().size();
        const double end = is_last ? span.end_s() : std::min(span.end_s(), m.end_s());
        const double curvature =
            m.primitive.isArc ? second_derivative_bound(m.primitive)[XYZ_NORM] + std::abs(m.primitive.omega)
                              : 0.0;
        const double step = end - s;
        const double straight = step * step * (bend + curvature) / 8;
        const double wanted = std::ceil(std::sqrt(straight / (BOUND_SLACK * m.tolerance)));
        const int parts = static_cast<int>(std::clamp(wanted, 1.0, MAX_PARTS));
        for (int i = 0; i <= parts; ++i) {
            const double at = s + step * i / parts;
            const double deviation =
                larger_norm(position_at(span, at) - path_.position_at(move, at)) + straight / (parts * parts);
            if (deviation > worst * m.tolerance) {
                worst = deviation / m.tolerance;
                worst_s = at;
            }
        }
        s = end;
        move += s < span.end_s() && !is_last ? 1 : 0;
    }
    if (worst > 1) {
        narrow(worst_s, worst, span.length);
    }
    return worst;
}

void CurveBuilder::move_spans(std::vector<Span> &spans) {
    start_s_ = final_s();
    spans.insert(spans.end(), spans_.begin(), spans_.end());
    spans_.clear();
}

bool CurveBuilder::check() {
    found_.clear();
    is_narrowed_ = false;
    worst_ = 0;
    std::size_t move = 0;
    for (OpenSpan &open : open_) {
        if (open.worst == UNKNOWN || open.worst > 1) {
            open.worst = check_span(open.span, move);
        }
        worst_ = std::max(worst_, open.worst);
    }
    return found_.empty() && !is_narrowed_;
}

void CurveBuilder::keep_final(bool complete) {
    // A corner after the end can reduce knot spacings up to this distance before it.
    const double end = complete ? path_.length() : path_.length() - widest_ / SPACING_GROWTH;
    std::size_t final = 0;
    while (final < open_.size() && open_[final].span.end_s() <= end &&
           (complete || first_open_ + final + 1 + KNOTS_BEHIND < knots_.size())) {
        spans_.push_back(open_[final++].span);
    }
    if (final == 0) {
        return;
    }
    final_worst_ = std::max(final_worst_, worst_);
    std::size_t open = first_open_ + final;
    const std::size_t drop = open > KNOTS_BEFORE ? open - KNOTS_BEFORE : 0;
    knots_.erase(knots_.begin(), knots_.begin() + static_cast<long>(drop));
    first_open_ = open - drop;
    fixed_ = std::min(first_open_ + KNOTS_BEHIND, knots_.size());
    // Caps and moves before the kept knots no longer affect the open part, except the last cap before them.
    std::size_t old = 0;
    while (old + 1 < caps_.size() && caps_[old + 1].s <= knots_[0]) {
        ++old;
    }
    caps_.erase(caps_.begin(), caps_.begin() + static_cast<long>(old));
    path_.drop_before(knots_[0]);
}

}  // namespace mw::trajectory::curve

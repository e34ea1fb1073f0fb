// SPDX-License-Identifier: GPL-2.0-or-later
#include "trajectory/curve/exact_builder.hh"

#include <algorithm>
#include <cmath>

namespace mw::trajectory::curve {

namespace {

/// The circular part of an arc, (radius + dradius s) (u cos(omega s) + v sin(omega s)), and its derivatives.
struct Round {
    std::array<double, 3> position{}, first{}, second{};
};

Round round_at(const Primitive &p, double s) noexcept {
    const double r = p.radius + p.dradius * s;
    const double c = std::cos(p.omega * s), d = std::sin(p.omega * s);
    Round out;
    for (std::size_t i = 0; i < 3; ++i) {
        const double along = p.u[i] * c + p.v[i] * d, across = p.v[i] * c - p.u[i] * d;
        out.position[i] = r * along;
        out.first[i] = p.dradius * along + r * p.omega * across;
        out.second[i] = 2 * p.dradius * p.omega * across - r * p.omega * p.omega * along;
    }
    return out;
}

/// Maximum length of the parts of an arc for LARGEST_ERROR. If a polynomial has the value and the first two
/// derivatives of a function at both ends of a length h, its error is at most (h/2)^6/6! times the bound of
/// the sixth derivative.
double longest_part(const Primitive &arc) noexcept {
    constexpr double PER_ERROR = 64 * 720;
    const double w = std::abs(arc.omega);
    const double r = std::max(arc.radius, arc.radius + arc.dradius * arc.length);
    const double sixth = std::pow(w, 5) * (r * w + 6 * std::abs(arc.dradius));
    return std::pow(PER_ERROR * ExactBuilder::LARGEST_ERROR * arc.radius / sixth, 1.0 / 6);
}

}  // namespace

Seam seam_between(const Span &before, const Span &after) noexcept {
    return {after.start_s, point_at(before, before.end_s()), point_at(after, after.start_s)};
}

void ExactBuilder::begin(double s) noexcept {
    spans_.clear();
    seams_.clear();
    final_s_ = s;
    is_first_ = true;
}

bool ExactBuilder::add(const Primitive &primitive) {
    if (!(primitive.length > 0)) {
        return false;
    }
    const double longest = primitive.isArc ? std::min(widest_, longest_part(primitive)) : widest_;
    const int parts = std::max(1, static_cast<int>(std::ceil(primitive.length / longest)));
    const std::size_t first = spans_.size();
    if (primitive.isArc) {
        add_arc(primitive, parts);
    } else {
        add_line(primitive, parts);
    }
    if (!is_first_) {
        seams_.push_back(seam_between(last_, spans_[first]));
    }
    is_first_ = false;
    last_ = spans_.back();
    return true;
}

void ExactBuilder::move_spans(std::vector<Span> &spans, std::vector<Seam> &seams) {
    spans.insert(spans.end(), spans_.begin(), spans_.end());
    seams.insert(seams.end(), seams_.begin(), seams_.end());
    spans_.clear();
    seams_.clear();
}

void ExactBuilder::add_line(const Primitive &line, int parts) {
    const double h = line.length / parts;
    for (int k = 0; k < parts; ++k) {
        Span span;
        span.start_s = final_s_;
        span.length = h;
        span.c[0] = trajectory::position_at(line, h * k);
        span.c[1] = line.lin * h;
        span.find_moving();
        spans_.push_back(span);
        final_s_ = span.end_s();
    }
}

void ExactBuilder::add_arc(const Primitive &arc, int parts) {
    const double h = arc.length / parts;
    Round to = round_at(arc, 0);
    for (int k = 0; k < parts; ++k) {
        const Round from = to;
        to = round_at(arc, h * (k + 1));
        Span span;
        span.start_s = final_s_;
        span.length = h;
        span.c[0] = trajectory::position_at(arc, h * k);
        span.c[1] = arc.lin * h;
        for (std::size_t i = 0; i < 3; ++i) {
            // Differences of the circular part avoid rounding errors at positions far from 0.
            const double d0 = from.first[i] * h, s0 = from.second[i] * h * h;
            const double by = to.position[i] - from.position[i] - d0 - 0.5 * s0;
            const double slope = to.first[i] * h - d0 - s0, bend = to.second[i] * h * h - s0;
            const std::size_t axis = static_cast<std::size_t>(arc.space) + i;
            span.c[1].c[axis] += d0;
            span.c[2].c[axis] = 0.5 * s0;
            span.c[3].c[axis] = 10 * by - 4 * slope + 0.5 * bend;
            span.c[4].c[axis] = -15 * by + 7 * slope - bend;
            span.c[5].c[axis] = 6 * by - 3 * slope + 0.5 * bend;
        }
        span.find_moving();
        spans_.push_back(span);
        final_s_ = span.end_s();
    }
}

}  // namespace mw::trajectory::curve

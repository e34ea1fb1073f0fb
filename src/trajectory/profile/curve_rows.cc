// SPDX-License-Identifier: GPL-2.0-or-later
// The rows of cells along a curve: velocity, acceleration and jerk of each coordinate.
#include <algorithm>
#include <bit>
#include <cmath>

#include "trajectory/profile/cap_rows.hh"
#include "trajectory/profile/cells.hh"

namespace mw::trajectory::profile {

namespace {

/// A point of the curve, with its derivatives by the parameter.
struct ParameterPoint {
    std::array<std::array<double, geometry::AXIS_COUNT>, 3> q{};
};

ParameterPoint by_parameter(const CurvePoint &p, const MapPoint &m) noexcept {
    ParameterPoint out;
    for (std::size_t i = 0; i < geometry::AXIS_COUNT; ++i) {
        out.q[0][i] = p.first.c[i] * m.first;
        out.q[1][i] = p.second.c[i] * m.first * m.first + p.first.c[i] * m.second;
        out.q[2][i] = p.third.c[i] * m.first * m.first * m.first + 3 * p.second.c[i] * m.first * m.second +
                      p.first.c[i] * m.third;
    }
    return out;
}

NormRow norm_row(const ParameterPoint &point, const Bounds &l, double bend) noexcept {
    const auto dot = [&](std::size_t i, std::size_t j) {
        const auto &x = point.q[i], &y = point.q[j];
        return x[0] * y[0] + x[1] * y[1] + x[2] * y[2];
    };
    const double a = 1 / (l.acceleration * l.acceleration), j = 1 / (l.jerk * l.jerk);
    return {a * dot(0, 0), a * dot(0, 1),     a * dot(1, 1),     j * dot(0, 0), 3 * j * dot(0, 1),
            j * dot(0, 2), 9 * j * dot(1, 1), 3 * j * dot(1, 2), j * dot(2, 2), bend / l.jerk};
}

/// Coordinates that move on the spans from `from_s` to `to_s`, one bit each.
unsigned moving_coordinates(const std::vector<Span> &spans, double from_s, double to_s) noexcept {
    unsigned moving = 0;
    for (std::size_t k = span_at(spans, from_s); k < spans.size() && spans[k].start_s <= to_s; ++k) {
        moving |= spans[k].moving;
    }
    return moving;
}

/// Distance inside a cell at which the span of its end is searched, as a fraction of half of the cell.
constexpr double INSIDE = 1e-3;

}  // namespace

double machine_share(const Run &run, const CurvePoint &point) noexcept {
    double most = geometry::norm_xyz(point.first) / run.limits.xyz.velocity;
    for (std::size_t i = 0; i < geometry::AXIS_COUNT; ++i) {
        if (point.first.c[i] != 0) {
            most = std::max(most, std::abs(point.first.c[i]) / run.limits.axes[i].velocity);
        }
    }
    return most;
}

double curve_speed(const Run &run, const CurvePoint &point) noexcept {
    double v = 1e300;
    const auto take = [&](const Bounds &b, double second, double third) {
        v = std::min({v, std::sqrt(b.acceleration / std::max(second, 1e-30)),
                      std::cbrt(b.jerk / std::max(third, 1e-30))});
    };
    for (std::size_t i = 0; i < geometry::AXIS_COUNT; ++i) {
        take(run.limits.axes[i], std::abs(point.second.c[i]), std::abs(point.third.c[i]));
    }
    take(run.limits.xyz, geometry::norm_xyz(point.second), geometry::norm_xyz(point.third));
    return v;
}

double speed_share(const Run &run, const CurvePoint &point, std::size_t feed) noexcept {
    const FeedLimit &limit = (*run.feeds)[feed];
    const double share =
        std::max(machine_share(run, point) / limit.limit_share, std::sqrt(limit.share(point.first)));
    return limit.curve_share < 1 ? std::max(share, 1 / (limit.curve_share * curve_speed(run, point))) : share;
}

void make_rows(const Run &run, const RestMap &map, const double *knots, std::size_t cells, Rows &rows) {
    const auto &spans = *run.spans;
    const unsigned moving = moving_coordinates(spans, map.at(knots[0]).s, map.at(knots[cells]).s);
    const Bounds &xyz = run.limits.xyz;
    const curve::JointCurve *joints = run.joint_curve;
    const std::size_t joint_count = joints == nullptr ? 0 : joints->joints();
    const std::size_t coordinates = static_cast<std::size_t>(std::popcount(moving)) + joint_count;
    rows.begin(coordinates + 1, xyz.acceleration < UNLIMITED_BOUND || xyz.jerk < UNLIMITED_BOUND);
    std::size_t span = span_at(spans, map.at(knots[0]).s);
    std::size_t feed = run.feed_at(map.at(knots[0]).s);
    std::array<MapPoint, PLACES> places;
    CurvePoint c;
    for (std::size_t k = 0; k < cells; ++k) {
        const double h = knots[k + 1] - knots[k];
        rows.add_cell(h);
        for (std::size_t p = 0; p < PLACES; ++p) {
            places[p] = p == 0 && k > 0 ? places[PLACES - 1] : map.at(knots[k] + h * PLACE_PART[p]);
        }
        const double from = places[0].s, to = places[PLACES - 1].s;
        const CapRest rest = rest_of(run, from, to);
        for (std::size_t p = 0; p < PLACES; ++p) {
            const MapPoint &m = places[p];
            // At an end of a cell, the derivatives on the side of the cell apply. They may jump there.
            const double inside = m.s + INSIDE * (0.5 * (from + to) - m.s);
            const std::size_t last_span = span;
            while (span + 1 < spans.size() && inside >= spans[span].end_s()) {
                ++span;
            }
            // The start of a cell is the end of the previous one.
            if (p > 0 || k == 0 || span != last_span) {
                c = curve::point_at(spans[span], m.s);
            }
            const ParameterPoint point = by_parameter(c, m);
            double joint_v2 = 0;
            std::size_t n = 0;
            BetweenRow between;
            for (std::size_t i = 0; i < geometry::AXIS_COUNT; ++i) {
                if ((moving >> i & 1U) == 0) {
                    continue;
                }
                const Bounds l = left_of(run.limits.axes[i], rest, i);
                const double q1 = point.q[0][i], q2 = point.q[1][i], q3 = point.q[2][i];
                rows.set(p, n++, row_of(q1, q2, q3, l, rest.bend[i] * m.first * m.first));
                between.take(q3, l);
            }
            if (joint_count > 0) {
                const curve::JointPoint point_j = joints->point_at(joints->part_at(inside), m.s);
                joint_v2 = set_joint_rows(run, point_j, m, rest, {rows, p, n, between});
            }
            rows.set(p, coordinates, between.row(h));
            if (rows.hasNorm()) {
                rows.set_norm(p, norm_row(point, left_of(xyz, rest, XYZ_NORM),
                                          rest.bend[XYZ_NORM] * m.first * m.first));
            }
            // Includes all moves between the previous and the next point, within the cell.
            const auto move_to = [&](std::size_t move, std::size_t place) {
                const double s = places[place].s;
                while (move + 1 < run.feeds->size() && s > (*run.feeds)[move].end_s) {
                    ++move;
                }
                return move;
            };
            const std::size_t last = move_to(feed, std::min(p + 1, PLACES - 1));
            feed = p == 0 ? move_to(feed, p) : feed;
            double share = 0, limit_share = 1;
            for (std::size_t j = feed; j <= last; ++j) {
                share = std::max(share, speed_share(run, c, j));
                limit_share = std::min(limit_share, (*run.feeds)[j].limit_share);
            }
            const double m2 = m.first * m.first;
            rows.set_velocity(p, std::max((square(share) + rest.v2) * m2, joint_v2 / square(limit_share)),
                              std::max((square(machine_share(run, c)) + rest.v2) * m2, joint_v2));
            feed = move_to(feed, p);
        }
    }
}

}  // namespace mw::trajectory::profile

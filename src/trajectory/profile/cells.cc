// SPDX-License-Identifier: GPL-2.0-or-later
#include "trajectory/profile/cells.hh"

#include <algorithm>
#include <bit>
#include <cmath>

#include "trajectory/curve/curve_builder.hh"
#include "trajectory/profile/cap_rows.hh"
#include "trajectory/profile/joint_speeds.hh"

namespace mw::trajectory::profile {

namespace {

constexpr int NODES_PER_SPAN = 3;
/// A limit above it is none.
constexpr double UNLIMITED_BOUND = 1e100;

double square(double x) noexcept {
    return x * x;
}

/// Nodes closer together count as one: rounding.
constexpr double LEAST_STEP = 1e-12;

/// Largest change of direction in a cell [rad].
constexpr double TURN_PER_CELL = 0.2;

bool isAlike(const FeedLimit &a, const FeedLimit &b) noexcept {
    return a.velocity == b.velocity && a.along == b.along;
}

/// Speed after the way ds from v with a^2 <= 2 J v (a start from rest with constant jerk) and a <= A.
double faster(double v, double ds, double acceleration, double jerk) noexcept {
    const double by_jerk = std::pow(v * std::sqrt(v) + 1.5 * std::sqrt(2 * jerk) * ds, 2.0 / 3);
    return std::min(by_jerk, std::sqrt(v * v + 2 * acceleration * ds));
}

}  // namespace

double FeedLimit::share(const Pose &first) const noexcept {
    const double length = along == Along::XYZ   ? geometry::norm_xyz(first)
                          : along == Along::UVW ? geometry::norm_uvw(first)
                                                : 1.0;
    return length * length / (velocity * velocity);
}

std::size_t Run::feed_at(double s) const noexcept {
    const auto at = std::lower_bound(feeds->begin(), feeds->end(), s,
                                     [](const FeedLimit &f, double x) { return f.end_s < x; });
    return std::min(static_cast<std::size_t>(at - feeds->begin()), feeds->size() - 1);
}

double RoughProfile::ramp_at(const Run &run, double s) noexcept {
    const Node node = node_at(run, span_at(*run.spans, s), s, s, 1e-9);
    const double t = std::min(node.acceleration / node.jerk, std::sqrt(node.v / node.jerk));
    return node.jerk * t * t * t / 6;
}

/// Whether a cap is at the node, whose speed it limits.
bool RoughProfile::apply_caps(const Run &run, Node &node, double tolerance) noexcept {
    bool is_cap = false;
    run.each_cap(node.s, node.s, [&](const SpeedCap &cap) {
        if (std::abs(cap.s - node.s) < tolerance) {
            node.v = std::min(node.v, cap.v);
            is_cap = true;
        }
    });
    return is_cap;
}

/// `from_s`: end of the stretch before it; the node has the least speed of the moves in it.
RoughProfile::Node RoughProfile::node_at(const Run &run, std::size_t span, double from_s, double s,
                                         double cell_s) noexcept {
    const CurvePoint p = curve::point_at((*run.spans)[span], s);
    Node node{s, 1e300, 1e300, 1e300, 0};
    double fastest = 1;
    for (std::size_t k = run.feed_at(from_s);; ++k) {
        const FeedLimit &feed = (*run.feeds)[k];
        node.v = std::min(node.v, 1 / std::sqrt(std::max(feed.share(p.first), 1e-30)));
        fastest = std::min(fastest, feed.limit_share);
        if (k + 1 == run.feeds->size() || feed.end_s >= s) {
            break;
        }
    }
    double direction = 0, bend = 0;
    for (std::size_t i = 0; i < geometry::AXIS_COUNT; ++i) {
        const Bounds &b = run.limits.axes[i];
        const double q1 = std::max(std::abs(p.first.c[i]), 1e-30);
        node.v = std::min({node.v, fastest * b.velocity / q1,
                           std::sqrt(b.acceleration / std::max(std::abs(p.second.c[i]), 1e-30)),
                           std::cbrt(b.jerk / std::max(std::abs(p.third.c[i]), 1e-30))});
        node.acceleration = std::min(node.acceleration, b.acceleration / q1);
        node.jerk = std::min(node.jerk, b.jerk / q1);
        direction += p.first.c[i] * p.first.c[i];
        bend += p.second.c[i] * p.second.c[i];
    }
    const Bounds &b = run.limits.xyz;
    const double n1 = std::max(geometry::norm_xyz(p.first), 1e-30);
    node.v = std::min({node.v, fastest * b.velocity / n1,
                       std::sqrt(b.acceleration / std::max(geometry::norm_xyz(p.second), 1e-30)),
                       std::cbrt(b.jerk / std::max(geometry::norm_xyz(p.third), 1e-30))});
    node.acceleration = std::min(node.acceleration, b.acceleration / n1);
    node.jerk = std::min(node.jerk, b.jerk / n1);
    // Where the feed changes both count.
    for (const std::size_t feed : {run.feed_at(s), run.feed_at(s + 2 * LEAST_STEP)}) {
        node.v = std::min(node.v, 1 / std::sqrt(std::max((*run.feeds)[feed].share(p.first), 1e-30)));
    }
    node.v = std::min(node.v,
                      TURN_PER_CELL / cell_s * std::sqrt(std::max(direction, 1e-4) / std::max(bend, 1e-30)));
    apply_joints(run, node, s + 1e-6 * ((*run.spans)[span].start_s + 0.5 * (*run.spans)[span].length - s),
                 cell_s);
    return node;
}

/// `inside`: a place on the side of the node whose curve counts.
void RoughProfile::apply_joints(const Run &run, Node &node, double inside, double cell_s) noexcept {
    if (run.joint_curve == nullptr) {
        return;
    }
    const curve::JointPoint p = run.joint_curve->point_at(run.joint_curve->part_at(inside), node.s);
    double direction = 0, bend = 0;
    for (std::size_t j = 0; j < run.joint_curve->joints(); ++j) {
        const Bounds b = bounds_of(run.joints, j);
        const double q1 = std::max(std::abs(p.first[j]), 1e-30);
        node.v = std::min({node.v, b.velocity / q1,
                           std::sqrt(b.acceleration / std::max(std::abs(p.second[j]), 1e-30)),
                           std::cbrt(b.jerk / std::max(std::abs(p.third[j]), 1e-30))});
        node.acceleration = std::min(node.acceleration, b.acceleration / q1);
        node.jerk = std::min(node.jerk, b.jerk / q1);
        direction += p.first[j] * p.first[j];
        bend += p.second[j] * p.second[j];
    }
    node.v = std::min(node.v,
                      TURN_PER_CELL / cell_s * std::sqrt(std::max(direction, 1e-4) / std::max(bend, 1e-30)));
}

const std::vector<double> &RoughProfile::lay(const Run &run, const Stretch &stretch) {
    knots_.clear();
    lay_nodes(run, stretch);
    if (nodes_.size() > 1) {
        lay_knots(run, stretch);
    }
    return knots_;
}

bool RoughProfile::isInEnd(const Run &run, const Stretch &stretch, double s) noexcept {
    return run.has_stop && s > run.end_s - stretch.end_ramp;
}

/// The next node behind `s`: thirds of spans, halves of the parts of the joints, places where the feed
/// changes.
double RoughProfile::next_place(const Run &run, const Span &span, double s) noexcept {
    double next = span.end_s();
    for (int n = NODES_PER_SPAN - 1; n > 0; --n) {
        const double third = span.start_s + span.length * n / NODES_PER_SPAN;
        next = third > s + LEAST_STEP ? third : next;
    }
    const auto &feeds = *run.feeds;
    for (std::size_t k = run.feed_at(s + LEAST_STEP); k + 1 < feeds.size() && feeds[k].end_s < next; ++k) {
        next = isAlike(feeds[k], feeds[k + 1]) ? next : feeds[k].end_s;
    }
    if (run.joint_curve != nullptr) {
        const curve::JointCurve::Part &part =
            run.joint_curve->parts()[run.joint_curve->part_at(s + LEAST_STEP)];
        for (const double half : {part.end_s(), part.start_s + 0.5 * part.length}) {
            next = half > s + LEAST_STEP ? std::min(next, half) : next;
        }
    }
    return next;
}

/// The speed of the last rough profile, which reached this place.
double RoughProfile::speed_at(double s) const noexcept {
    const auto behind =
        std::partition_point(nodes_.begin(), nodes_.end(), [&](const Node &n) { return n.s < s; });
    if (behind == nodes_.begin() || behind == nodes_.end()) {
        return 1e300;
    }
    const Node &b = *behind, &a = *(behind - 1);
    return a.v + (b.v - a.v) * (s - a.s) / (b.s - a.s);
}

/// Lays nodes until the motion without braking takes 1.5 times the horizon, then limits their speeds by
/// braking.
void RoughProfile::lay_nodes(const Run &run, const Stretch &stretch) {
    constexpr double FARTHER = 1.5;
    const double reached = stretch.from_rest ? 0.0 : speed_at(stretch.from_s);
    nodes_.clear();
    reaches_end_ = false;
    const auto &spans = *run.spans;
    std::size_t k = span_at(spans, stretch.from_s);
    nodes_.push_back(node_at(run, k, stretch.from_s, stretch.from_s, stretch.cell_s));
    nodes_.back().v = std::min(nodes_.back().v, reached);
    double t = 0;
    for (; k < spans.size() && spans[k].start_s < run.end_s &&
           (t < FARTHER * stretch.horizon_s || isInEnd(run, stretch, nodes_.back().s));
         ++k) {
        const double end = std::min(run.end_s, spans[k].end_s());
        while (nodes_.back().s + LEAST_STEP < end) {
            const Node last = nodes_.back();
            const double s = std::min(end, next_place(run, spans[k], last.s));
            Node node = node_at(run, k, last.s, s, stretch.cell_s);
            node.is_cap = apply_caps(run, node, 1e-6 * spans[k].length + 1e-15 * std::abs(s));
            if (node.is_cap && k + 1 < spans.size()) {
                const Node behind = node_at(run, k + 1, s, s, stretch.cell_s);
                node.v = std::min(node.v, behind.v);
                node.acceleration = std::min(node.acceleration, behind.acceleration);
                node.jerk = std::min(node.jerk, behind.jerk);
            }
            node.v = std::min(node.v, faster(last.v, s - last.s, node.acceleration, node.jerk));
            t += 2 * (s - last.s) / (last.v + node.v);
            nodes_.push_back(node);
        }
    }
    if (nodes_.size() == 2) {
        // A start and a stop have a place between them that moves.
        const Node &first = nodes_.front(), &last = nodes_.back();
        const double way = 0.5 * (last.s - first.s), s = first.s + way;
        Node node = node_at(run, span_at(spans, s), first.s, s, stretch.cell_s);
        node.v = std::min(node.v, faster(first.v, way, node.acceleration, node.jerk));
        nodes_.insert(nodes_.begin() + 1, node);
    }
    reaches_end_ = nodes_.back().s >= run.end_s - 2 * LEAST_STEP;
    if (reaches_end_) {
        nodes_.back().s = run.end_s;
        nodes_.back().v = run.has_stop ? 0 : nodes_.back().v;
    }
    for (std::size_t i = nodes_.size() - 1; i-- > 0;) {
        Node &n = nodes_[i];
        const Node &next = nodes_[i + 1];
        n.v = std::min(n.v, faster(next.v, next.s - n.s, n.acceleration, n.jerk));
    }
}

void RoughProfile::lay_knots(const Run &run, const Stretch &stretch) {
    for (std::size_t i = 1; i < nodes_.size(); ++i) {
        const Node &a = nodes_[i - 1];
        Node &b = nodes_[i];
        b.t = a.t + (std::min(a.v, b.v) == 0 ? 3.0 : 2.0) * (b.s - a.s) / (a.v + b.v);
    }
    const double whole = nodes_.back().t;
    const auto last = std::find_if(nodes_.begin(), nodes_.end(),
                                   [&](const Node &n) { return n.t >= stretch.horizon_s + stretch.cell_s; });
    const bool is_all = reaches_end_ && (last == nodes_.end() || isInEnd(run, stretch, last->s));
    const double time = is_all ? whole : std::min(whole, stretch.horizon_s);
    // A cell ends at each cap.
    double from = 0;
    std::size_t node = 1;
    for (std::size_t i = 1; i < nodes_.size() && nodes_[i].t < time; ++i) {
        if (nodes_[i].is_cap) {
            lay_between(from, nodes_[i].t, stretch.cell_s, node);
            knots_.back() = nodes_[i].s;
            from = nodes_[i].t;
        }
    }
    if (is_all || time - from > 0.5 * stretch.cell_s) {
        lay_between(from, time, stretch.cell_s, node);
    }
    if (is_all) {
        knots_.back() = nodes_.back().s;
    }
}

/// Cells about as long as `cell_s` between two times; `node`: one at or before the first of them.
void RoughProfile::lay_between(double from_t, double to_t, double cell_s, std::size_t &node) {
    const auto cells = static_cast<std::size_t>(std::max(1.0, std::ceil((to_t - from_t) / cell_s)));
    const double h = (to_t - from_t) / static_cast<double>(cells);
    for (std::size_t k = 1; k <= cells; ++k) {
        const double t = from_t + h * static_cast<double>(k);
        while (node + 1 < nodes_.size() && nodes_[node].t < t) {
            ++node;
        }
        const Node &a = nodes_[node - 1];
        const Node &b = nodes_[node];
        const double x = std::clamp((t - a.t) / (b.t - a.t), 0.0, 1.0);
        const double y = 1 - x;
        knots_.push_back(a.v == 0   ? a.s + (b.s - a.s) * x * x * x
                         : b.v == 0 ? b.s - (b.s - a.s) * y * y * y
                                    : a.s + x * (b.t - a.t) * (a.v + 0.5 * (b.v - a.v) * x));
    }
}

namespace {

using curve::SPACING_GROWTH;

Bounds least_of(const CurveLimits &limits) noexcept {
    Bounds least = limits.xyz;
    for (const Bounds &b : limits.axes) {
        least.velocity = std::min(least.velocity, b.velocity);
        least.acceleration = std::min(least.acceleration, b.acceleration);
        least.jerk = std::min(least.jerk, b.jerk);
    }
    return least;
}

/// Lengths over which the path, its map and its speed limits change, at the middle of each cell.
class Scales {
  public:
    Scales(const Run &run, const Bounds &least) : run_(run), least_(least) {}

    /// The scale that a cell has already.
    struct Known {
        std::size_t cell = 0;
        double scale = 1e300, speed = 1e300;
    };
    const std::vector<double> &find(const RestMap &map, const std::vector<double> &knots, double end_ramp,
                                    const Known &known) {
        const auto &spans = *run_.spans;
        const std::size_t cells = knots.size() - 1;
        scale_.resize(cells);
        by_speed_.resize(cells + 2);
        std::size_t span = span_at(spans, map.at(knots[0]).s);
        std::size_t feed = run_.feed_at(map.at(knots[0]).s);
        double s = 0;
        for (std::size_t k = 0; k < cells; ++k) {
            const double middle = 0.5 * (knots[k] + knots[k + 1]);
            s = map.at(middle).s;
            // All spans and moves in the cell: a short one may lie between the places where limits are
            // checked.
            double length = spans[span].length;
            while (span + 1 < spans.size() && map.at(knots[k + 1]).s >= spans[span].end_s()) {
                length = std::min(length, spans[++span].length);
            }
            double v = speed_of((*run_.feeds)[feed]);
            while (feed + 1 < run_.feeds->size() && map.at(knots[k + 1]).s >= (*run_.feeds)[feed].end_s) {
                v = std::min(v, speed_of((*run_.feeds)[++feed]));
            }
            const double before_stop =
                RestMap::scale_of(end_ramp) + SPACING_GROWTH * std::max(0.0, run_.end_s - end_ramp - s);
            run_.each_cap(map.at(knots[k]).s, map.at(knots[k + 1]).s,
                          [&](const SpeedCap &cap) { v = std::min(v, cap.v); });
            scale_[k] = std::min({length, map.scale_at(middle), before_stop});
            by_speed_[k + 1] = scale_of_speed(v);
        }
        look_ahead(s, map.at(knots[cells]).s - map.at(knots[cells - 1]).s, span, feed);
        // The speed in a cell depends on the coefficients of its neighbours, too.
        by_speed_[0] = by_speed_[cells + 1] = 1e300;
        for (std::size_t k = 0; k < cells; ++k) {
            scale_[k] = std::min({scale_[k], by_speed_[k], by_speed_[k + 1], by_speed_[k + 2]});
        }
        scale_[known.cell] = std::min(scale_[known.cell], known.scale);
        if (run_.joint_curve != nullptr) {
            const std::vector<double> &speed =
                joint_speeds_.find(*run_.joint_curve, map, knots, {known.cell, known.speed});
            for (std::size_t k = 0; k < cells; ++k) {
                scale_[k] = std::min(scale_[k], scale_of_speed(speed[k]));
            }
        }
        spread(knots);
        return scale_;
    }

  private:
    double speed_of(const FeedLimit &feed) const noexcept {
        return std::min(feed.limit_share * least_.velocity, feed.velocity);
    }
    /// The scale at which the jerk limit gives this speed.
    double scale_of_speed(double v) const noexcept { return std::sqrt(v * v * v / least_.jerk); }

    /// Reduces the scale of the last cell, of this length, for smaller scales of the path and of the feeds
    /// behind it.
    void look_ahead(double s, double cell, std::size_t span, std::size_t feed) {
        double &last = scale_.back();
        const auto &spans = *run_.spans;
        for (std::size_t j = span + 1; j < spans.size() && SPACING_GROWTH * (spans[j].start_s - s) < last;
             ++j) {
            last = std::min(last, spans[j].length + SPACING_GROWTH * std::max(0.0, spans[j].start_s - s));
        }
        // The cell in which a slower move begins has the slower speed at its start.
        const auto apart = [&](std::size_t j) { return (*run_.feeds)[j - 1].end_s - s - 2 * cell; };
        for (std::size_t j = feed + 1; j < run_.feeds->size() && SPACING_GROWTH * apart(j) < last; ++j) {
            last = std::min(last, scale_of_speed(speed_of((*run_.feeds)[j])) +
                                      SPACING_GROWTH * std::max(0.0, apart(j)));
        }
        run_.each_cap(s, s + last / SPACING_GROWTH, [&](const SpeedCap &cap) {
            last =
                std::min(last, scale_of_speed(cap.v) + SPACING_GROWTH * std::max(0.0, cap.s - cap.reach - s));
        });
    }

    void spread(const std::vector<double> &knots) {
        const auto apart = [&](std::size_t k) {
            return SPACING_GROWTH * 0.5 * (knots[k + 1] - knots[k - 1]);
        };
        for (std::size_t k = 1; k < scale_.size(); ++k) {
            scale_[k] = std::min(scale_[k], scale_[k - 1] + apart(k));
        }
        for (std::size_t k = scale_.size() - 1; k > 0; --k) {
            scale_[k - 1] = std::min(scale_[k - 1], scale_[k] + apart(k));
        }
    }

    const Run &run_;
    const Bounds &least_;
    std::vector<double> scale_, by_speed_;
    JointSpeeds joint_speeds_;
};

}  // namespace

namespace {

/// Speed of a creep over that at which the path alone takes all of the jerk or of the acceleration.
constexpr double SHARE = 0.15;

/// The scale of the path that a creep belongs to.
double scale_of_creep(const Bounds &least, double c) noexcept {
    const double v = std::sqrt(c) / SHARE;
    return std::max(std::sqrt(v * v * v / least.jerk), v * v / least.acceleration);
}

}  // namespace

double creep_scale(const Run &run, double c) noexcept {
    return scale_of_creep(least_of(run.limits), c);
}

bool isSteady(const Run &run, double c, double next, double apart) noexcept {
    return std::abs(creep_scale(run, next) - creep_scale(run, c)) <= SPACING_GROWTH * apart;
}

void creep(const Run &run, const RestMap &map, const std::vector<double> &knots, double end_ramp,
           std::vector<double> &c) {
    const Bounds least = least_of(run.limits);
    Scales scales(run, least);
    // Coefficient k belongs to the middle of cell k - 1.
    const std::size_t cells = knots.size() - 1;
    const auto cell_of = [&](std::size_t k) { return std::clamp<std::size_t>(k, 1, cells) - 1; };
    Scales::Known known;
    const std::size_t old = c.size();
    const double from = old == 0 ? 0 : scale_of_creep(least, c.back());
    if (old > 0) {
        known = {cell_of(old - 1), from, std::sqrt(c.back()) / SHARE};
    }
    const std::vector<double> &scale = scales.find(map, knots, end_ramp, known);
    const auto middle = [&](std::size_t k) { return 0.5 * (knots[cell_of(k)] + knots[cell_of(k) + 1]); };
    // The scale that the last coefficient belongs to changes into the present one.
    for (std::size_t k = old; k < cells + 2; ++k) {
        double d = scale[cell_of(k)];
        if (old > 0) {
            // Down at a slope of 1: slow moves that lie within a cell are not seen as far ahead.
            const double way = middle(k) - middle(old - 1);
            d = std::clamp(d, from - way, from + SPACING_GROWTH * way);
        }
        c.push_back(
            square(SHARE * std::min(std::cbrt(least.jerk * d * d), std::sqrt(least.acceleration * d))));
    }
}

std::size_t span_at(const std::vector<Span> &spans, double s) noexcept {
    const auto behind = std::upper_bound(spans.begin(), spans.end(), s,
                                         [](double x, const Span &span) { return x < span.start_s; });
    return static_cast<std::size_t>(std::max<long>(0, behind - spans.begin() - 1));
}

namespace {

/// A point of the curve, its derivatives by the parameter.
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

/// Coordinates that move on the spans of a stretch, as bits.
unsigned moving_coordinates(const std::vector<Span> &spans, double from_s, double to_s) noexcept {
    unsigned moving = 0;
    for (std::size_t k = span_at(spans, from_s); k < spans.size() && spans[k].start_s <= to_s; ++k) {
        const Span &span = spans[k];
        for (std::size_t i = 0; i < geometry::AXIS_COUNT; ++i) {
            moving |= span.c[1].c[i] != 0 || span.c[2].c[i] != 0 || span.c[3].c[i] != 0 ? 1U << i : 0U;
        }
    }
    return moving;
}

/// How far inside of a cell the span for its end is searched, as a part of half of the cell.
constexpr double INSIDE = 1e-3;

}  // namespace

double speed_share(const Run &run, const CurvePoint &point, std::size_t feed) noexcept {
    const FeedLimit &limit = (*run.feeds)[feed];
    double most = geometry::norm_xyz(point.first) / run.limits.xyz.velocity;
    for (std::size_t i = 0; i < geometry::AXIS_COUNT; ++i) {
        most = std::max(most, std::abs(point.first.c[i]) / run.limits.axes[i].velocity);
    }
    return std::max(most / limit.limit_share, std::sqrt(limit.share(point.first)));
}

void make_rows(const Run &run, const RestMap &map, const double *knots, std::size_t cells, Rows &rows) {
    const auto &spans = *run.spans;
    const unsigned moving = moving_coordinates(spans, map.at(knots[0]).s, map.at(knots[cells]).s);
    const Bounds &xyz = run.limits.xyz;
    const curve::JointCurve *joints = run.joint_curve;
    const std::size_t joint_count = joints == nullptr ? 0 : joints->joints();
    rows.begin(static_cast<std::size_t>(std::popcount(moving)) + joint_count,
               xyz.acceleration < UNLIMITED_BOUND || xyz.jerk < UNLIMITED_BOUND);
    std::size_t span = span_at(spans, map.at(knots[0]).s);
    std::size_t feed = run.feed_at(map.at(knots[0]).s);
    for (std::size_t k = 0; k < cells; ++k) {
        const double h = knots[k + 1] - knots[k];
        rows.add_cell(h);
        const double from = map.at(knots[k]).s, to = map.at(knots[k + 1]).s;
        const CapRest rest = rest_of(run, from, to);
        for (std::size_t p = 0; p < PLACES; ++p) {
            const MapPoint m = map.at(knots[k] + h * PLACE_PART[p]);
            // At the ends of a cell the curve on the side of the cell: derivatives may jump there.
            const double inside = m.s + INSIDE * (0.5 * (from + to) - m.s);
            while (span + 1 < spans.size() && inside >= spans[span].end_s()) {
                ++span;
            }
            const CurvePoint c = curve::point_at(spans[span], m.s);
            const ParameterPoint point = by_parameter(c, m);
            double joint_v2 = 0;
            std::size_t n = 0;
            for (std::size_t i = 0; i < geometry::AXIS_COUNT; ++i) {
                if ((moving >> i & 1U) == 0) {
                    continue;
                }
                const Bounds l = left_of(run.limits.axes[i], rest, i);
                const double q1 = point.q[0][i], q2 = point.q[1][i], q3 = point.q[2][i];
                rows.set(p, n++, row_of(q1, q2, q3, l, rest.bend[i] * m.first * m.first));
            }
            if (joint_count > 0) {
                const curve::JointPoint point_j = joints->point_at(joints->part_at(inside), m.s);
                joint_v2 = set_joint_rows(run, point_j, m, rest, {rows, p, n});
            }
            if (rows.hasNorm()) {
                rows.set_norm(p, norm_row(point, left_of(xyz, rest, XYZ_NORM),
                                          rest.bend[XYZ_NORM] * m.first * m.first));
            }
            // All moves from the place before to that behind, in the cell.
            const auto move_to = [&](std::size_t move, std::size_t place) {
                const double s = map.at(knots[k] + h * PLACE_PART[place]).s;
                while (move + 1 < run.feeds->size() && s > (*run.feeds)[move].end_s) {
                    ++move;
                }
                return move;
            };
            const std::size_t last = move_to(feed, std::min(p + 1, PLACES - 1));
            feed = p == 0 ? move_to(feed, p) : feed;
            double share = 0;
            for (std::size_t j = feed; j <= last; ++j) {
                share = std::max(share, speed_share(run, c, j));
            }
            const double v2 = (square(share) + rest.v2) * m.first * m.first;
            rows.set_velocity(p, std::max(v2, joint_v2));
            feed = move_to(feed, p);
        }
    }
}

}  // namespace mw::trajectory::profile

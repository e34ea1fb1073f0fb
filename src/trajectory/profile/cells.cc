// SPDX-License-Identifier: GPL-2.0-or-later
#include "trajectory/profile/cells.hh"

#include <algorithm>
#include <cmath>

#include "trajectory/curve/curve_builder.hh"
#include "trajectory/profile/cap_rows.hh"
#include "trajectory/profile/joint_speeds.hh"

namespace mw::trajectory::profile {

namespace {

constexpr int NODES_PER_SPAN = 3;
/// Maximum change of direction in a cell [rad].
constexpr double TURN_PER_CELL = 0.2;
/// Minimum number of cells in the time A/J, and in the time of a span.
constexpr double CELLS_PER_RAMP = 10, CELLS_PER_SPAN = 6;
/// Minimum number of cells in the time of a start with constant jerk, because the map changes there.
constexpr double CELLS_PER_START = 25;
/// Maximum relative change of the speed in a cell. The jerk limit along the parameter is J/sqrt(b), which is
/// far from linear in a cell if the speed changes by more.
constexpr double CHANGE_PER_CELL = 0.3;
/// Minimum and maximum time of a cell [s], maximum time of a cell if joints are not axes [s], maximum
/// relative change of this time from cell to cell.
constexpr double LEAST_CELL_S = 5e-4, MOST_CELL_S = 1e-2, MOST_JOINT_CELL_S = 2e-3, CELL_GROWTH = 0.04;
/// Maximum number of cells of a window, and minimum number between two stops. The jerk can change only at
/// ends of cells.
constexpr std::size_t MOST_CELLS = 2000, FEWEST_CELLS = 70;

bool isAlike(const FeedLimit &a, const FeedLimit &b) noexcept {
    return a.velocity == b.velocity && a.along == b.along && a.limit_share == b.limit_share;
}

/// Time A/J, in which the jerk limit builds up the maximum acceleration [s].
double ramp_of(const Bounds &b) noexcept {
    return b.acceleration < UNLIMITED_BOUND ? b.acceleration / b.jerk : 1e300;
}

/// Distance over which the direction changes by the maximum for a cell.
double turn_distance(double direction, double bend) noexcept {
    return TURN_PER_CELL * std::sqrt(std::max(direction, 1e-4) / std::max(bend, 1e-30));
}

/// Speed after the distance ds from v, with a^2 <= 2 J v (a start from standstill with constant jerk) and a
/// <= A.
double faster(double v, double ds, double acceleration, double jerk) noexcept {
    const double by_jerk = std::pow(v * std::sqrt(v) + 1.5 * std::sqrt(2 * jerk) * ds, 2.0 / 3);
    return std::min(by_jerk, std::sqrt(v * v + 2 * acceleration * ds));
}

}  // namespace

double RoughProfile::ramp_at(const Run &run, double s) noexcept {
    const Node node = node_at(run, span_at(*run.spans, s), s, s);
    return node.jerk * node.rest_s * node.rest_s * node.rest_s / 6;
}

/// Limits the speed of the node to that of the caps there. `length`: length of the span.
void RoughProfile::apply_caps(const Run &run, Node &node, double length) noexcept {
    const double rounding = 1e-6 * length + 1e-15 * std::abs(node.s);
    run.each_cap(node.s - rounding, node.s + rounding, [&](const SpeedCap &cap) {
        if (std::abs(cap.s - node.s) < rounding) {
            node.v = std::min(node.v, cap.v);
            node.cap_s = cap.s;
        }
    });
}

/// The node at s. `from_s`: previous node. The slowest move between both determines the speed.
RoughProfile::Node RoughProfile::node_at(const Run &run, std::size_t span, double from_s, double s) noexcept {
    const CurvePoint p = curve::point_at((*run.spans)[span], s);
    Node node{s, 1e300, 1e300, 1e300, 0};
    double fastest = 1, curve_share = 1;
    for (std::size_t k = run.feed_at(from_s);; ++k) {
        const FeedLimit &feed = (*run.feeds)[k];
        node.v = std::min(node.v, 1 / std::sqrt(std::max(feed.share(p.first), 1e-30)));
        fastest = std::min(fastest, feed.limit_share);
        curve_share = std::min(curve_share, feed.curve_share);
        if (k + 1 == run.feeds->size() || feed.end_s >= s) {
            break;
        }
    }
    double direction = 0, bend = 0;
    for (std::size_t i = 0; i < geometry::AXIS_COUNT; ++i) {
        const Bounds &b = run.limits.axes[i];
        const double q1 = std::max(std::abs(p.first.c[i]), 1e-30);
        node.machine_v = std::min(node.machine_v, b.velocity / q1);
        node.acceleration = std::min(node.acceleration, b.acceleration / q1);
        node.jerk = std::min(node.jerk, b.jerk / q1);
        if (std::abs(p.first.c[i]) + std::abs(p.second.c[i]) > 0) {
            node.ramp_s = std::min(node.ramp_s, ramp_of(b));
        }
        direction += p.first.c[i] * p.first.c[i];
        bend += p.second.c[i] * p.second.c[i];
    }
    const Bounds &b = run.limits.xyz;
    const double n1 = std::max(geometry::norm_xyz(p.first), 1e-30);
    node.machine_v = std::min(node.machine_v, b.velocity / n1);
    node.curve_v = curve_speed(run, p);
    node.acceleration = std::min(node.acceleration, b.acceleration / n1);
    node.jerk = std::min(node.jerk, b.jerk / n1);
    // Where the feed changes, the feeds on both sides apply, unless the motion stops there.
    for (const std::size_t feed :
         {run.feed_at(s),
          run.feed_at(run.has_stop ? std::min(s + 2 * rounding_at(s), run.end_s) : s + 2 * rounding_at(s))}) {
        node.v = std::min(node.v, 1 / std::sqrt(std::max((*run.feeds)[feed].share(p.first), 1e-30)));
        curve_share = std::min(curve_share, (*run.feeds)[feed].curve_share);
    }
    node.ramp_s = std::min(node.ramp_s, ramp_of(b));
    double turn_v = turn_distance(direction, bend) / LEAST_CELL_S;
    apply_joints(run, node, s + 1e-6 * ((*run.spans)[span].start_s + 0.5 * (*run.spans)[span].length - s),
                 turn_v);
    apply_velocity(node, fastest);
    node.v = std::min(node.v, curve_share * node.curve_v);
    node.way = (*run.spans)[span].length / CELLS_PER_SPAN;
    node.rest_s = std::min(node.acceleration / node.jerk, std::sqrt(node.v / node.jerk));
    node.v = std::min(node.v, turn_v);
    return node;
}

/// Between two points of a cell a time T apart, the speed exceeds the lower one by at most j T^2/8. Near a
/// velocity limit, cells are so short that this is within the margin. `fastest`: fraction of the velocity
/// limits that the moves may use.
void RoughProfile::apply_velocity(Node &node, double fastest) noexcept {
    constexpr double NEAR = 0.99, BETWEEN = 8e-4;
    node.v = std::min(node.v, fastest * node.machine_v);
    if (node.v >= NEAR * node.machine_v && node.v < NEAR * node.curve_v) {
        node.velocity_s = std::sqrt(32 * BETWEEN * node.machine_v / node.jerk);
    }
}

/// `inside`: a position on the side of the node whose curve applies. `turn_v`: speed at which the direction
/// changes by its maximum in the shortest cell.
void RoughProfile::apply_joints(const Run &run, Node &node, double inside, double &turn_v) noexcept {
    if (run.joint_curve == nullptr) {
        return;
    }
    const std::size_t part = run.joint_curve->part_at(inside);
    const curve::JointPoint p = run.joint_curve->point_at(part, node.s);
    double direction = 0, bend = 0;
    for (std::size_t j = 0; j < run.joint_curve->joints(); ++j) {
        const Bounds b = bounds_of(run.joints, j);
        const double q1 = std::max(std::abs(p.first[j]), 1e-30);
        node.machine_v = std::min(node.machine_v, b.velocity / q1);
        node.curve_v =
            std::min({node.curve_v, std::sqrt(b.acceleration / std::max(std::abs(p.second[j]), 1e-30)),
                      std::cbrt(b.jerk / std::max(std::abs(p.third[j]), 1e-30))});
        node.acceleration = std::min(node.acceleration, b.acceleration / q1);
        node.jerk = std::min(node.jerk, b.jerk / q1);
        if (std::abs(p.first[j]) + std::abs(p.second[j]) > 0) {
            node.ramp_s = std::min(node.ramp_s, ramp_of(b));
        }
        direction += p.first[j] * p.first[j];
        bend += p.second[j] * p.second[j];
    }
    turn_v = std::min(turn_v, turn_distance(direction, bend) / LEAST_CELL_S);
}

const std::vector<RoughProfile::CellEnd> &RoughProfile::lay(const Run &run, const Stretch &stretch) {
    knots_.clear();
    lay_nodes(run, stretch);
    if (nodes_.size() > 1) {
        lay_knots(run, stretch);
    }
    return knots_;
}

bool RoughProfile::isInRamp(const Run &run, const Stretch &stretch, double s) noexcept {
    const double rounding = 2 * rounding_at(s);
    return s < stretch.from_s + stretch.start_ramp + rounding ||
           (run.has_stop && s > run.end_s - stretch.end_ramp - rounding);
}

bool RoughProfile::isInEnd(const Run &run, const Stretch &stretch, double s) noexcept {
    return run.has_stop && s > run.end_s - stretch.end_ramp;
}

/// s of the next node after `s`: thirds of spans, halves of the parts of the joints, positions where the feed
/// changes.
double RoughProfile::next_place(const Run &run, const Stretch &stretch, const Span &span, double s) noexcept {
    const double rounding = rounding_at(s);
    double next = span.end_s();
    const auto take = [&](double candidate) {
        next = candidate > s + rounding && candidate < next - rounding ? candidate : next;
    };
    for (int n = NODES_PER_SPAN - 1; n > 0; --n) {
        const double third = span.start_s + span.length * n / NODES_PER_SPAN;
        take(third);
    }
    take(stretch.from_s + stretch.start_ramp);
    take(run.has_stop ? run.end_s - stretch.end_ramp : next);
    const auto &feeds = *run.feeds;
    for (std::size_t k = run.feed_at(s + rounding); k + 1 < feeds.size() && feeds[k].end_s < next - rounding;
         ++k) {
        next = isAlike(feeds[k], feeds[k + 1]) ? next : feeds[k].end_s;
    }
    if (run.joint_curve != nullptr) {
        const curve::JointCurve::Part &part =
            run.joint_curve->parts()[run.joint_curve->part_at(s + rounding)];
        for (const double half : {part.end_s(), part.start_s + 0.5 * part.length}) {
            take(half);
        }
    }
    return next;
}

/// Speed of the last rough profile at s; 1e300: outside.
double RoughProfile::speed_at(double s) const noexcept {
    const auto behind =
        std::partition_point(nodes_.begin(), nodes_.end(), [&](const Node &n) { return n.s < s; });
    if (behind == nodes_.begin() || behind == nodes_.end()) {
        return 1e300;
    }
    const Node &b = *behind, &a = *(behind - 1);
    return a.v + (b.v - a.v) * (s - a.s) / (b.s - a.s);
}

/// True if, in the middle between two nodes, the motion can be much faster than the rough profile assumes.
bool RoughProfile::isFasterBetween(const Run &run, std::size_t span, const Node &a, const Node &b) noexcept {
    constexpr double FASTER = 1.25;
    // In the middle of a distance from or to standstill with constant jerk, the speed is 0.5^(2/3) of the
    // final speed.
    constexpr double MIDDLE_OF_CUBE = 0.63;
    const double half = 0.5 * (b.s - a.s);
    const double middle = std::min(a.v, b.v) > 0 ? std::sqrt(0.5 * (a.v * a.v + b.v * b.v))
                                                 : MIDDLE_OF_CUBE * std::max(a.v, b.v);
    const double ends = FASTER * middle;
    const double reached =
        std::min(faster(a.v, half, b.acceleration, b.jerk), faster(b.v, half, b.acceleration, b.jerk));
    return reached > ends && half > rounding_at(a.s) && node_at(run, span, a.s, a.s + half).v > ends;
}

/// Makes nodes until the motion without braking takes 1.5 times the needed time. Then limits their speeds so
/// that braking is possible.
void RoughProfile::lay_nodes(const Run &run, const Stretch &stretch) {
    constexpr double FARTHER = 1.5;
    stop_s_ = 0;
    const auto take_stop = [this](const Node &n) {
        stop_s_ = std::max(stop_s_, n.v / n.acceleration + n.rest_s);
    };
    const double reached = stretch.from_rest ? 0.0 : speed_at(stretch.from_s);
    nodes_.clear();
    reaches_end_ = false;
    const auto &spans = *run.spans;
    std::size_t k = span_at(spans, stretch.from_s);
    nodes_.push_back(node_at(run, k, stretch.from_s, stretch.from_s));
    nodes_.back().v = std::min(nodes_.back().v, reached);
    apply_caps(run, nodes_.back(), spans[k].length);
    take_stop(nodes_.back());
    double t = 0;
    bool has_speed = true;
    for (; has_speed && k < spans.size() && spans[k].start_s < run.end_s &&
           (t < FARTHER * time_left(stretch) || isInEnd(run, stretch, nodes_.back().s));
         ++k) {
        const double end = std::min(run.end_s, spans[k].end_s());
        while (nodes_.back().s + rounding_at(end) < end) {
            const Node last = nodes_.back();
            double s = next_place(run, stretch, spans[k], last.s);
            s = s < end - rounding_at(end) ? s : end;
            Node node = node_at(run, k, last.s, s);
            const auto is_coarse = [&] {
                Node to = node;
                to.v = run.has_stop && s >= run.end_s - 2 * rounding_at(s) ? 0 : node.v;
                return isFasterBetween(run, k, last, to);
            };
            while (is_coarse()) {
                s = last.s + 0.5 * (s - last.s);
                node = node_at(run, k, last.s, s);
            }
            has_speed = node.v > 0;
            if (!has_speed) {
                break;  // no cells: the motion stops before this node
            }
            apply_caps(run, node, spans[k].length);
            if (node.cap_s > NOWHERE && k + 1 < spans.size()) {
                const Node behind = node_at(run, k + 1, s, s);
                node.v = std::min(node.v, behind.v);
                node.acceleration = std::min(node.acceleration, behind.acceleration);
                node.jerk = std::min(node.jerk, behind.jerk);
            }
            node.v = std::min(node.v, faster(last.v, s - last.s, node.acceleration, node.jerk));
            t += 2 * (s - last.s) / (last.v + node.v);
            take_stop(node);
            nodes_.push_back(node);
        }
    }
    if (nodes_.size() == 2) {
        // Between a start and a stop, one more node with a speed is needed.
        const Node &first = nodes_.front(), &last = nodes_.back();
        const double half_length = 0.5 * (last.s - first.s), s = first.s + half_length;
        Node node = node_at(run, span_at(spans, s), first.s, s);
        node.v = std::min(node.v, faster(first.v, half_length, node.acceleration, node.jerk));
        nodes_.insert(nodes_.begin() + 1, node);
    }
    reaches_end_ = nodes_.back().s >= run.end_s - 2 * rounding_at(run.end_s);
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

/// Sets the time of a cell at each node: a fraction of the times in which the motion or the curve changes. It
/// changes slowly from node to node.
void RoughProfile::size_cells(const Run &run, const Stretch &stretch) {
    const double most_s = run.joint_curve == nullptr ? MOST_CELL_S : MOST_JOINT_CELL_S;
    for (Node &n : nodes_) {
        // The fraction of an acceleration limit that the curvature uses.
        const double part = n.v * n.v / (n.curve_v * n.curve_v);
        n.cell_s = std::clamp(
            std::min({n.ramp_s / CELLS_PER_RAMP, n.velocity_s, n.way / std::max(n.v * part, 1e-300)}),
            LEAST_CELL_S, most_s);
        if (isInRamp(run, stretch, n.s)) {
            n.cell_s = std::clamp(n.rest_s / CELLS_PER_START, LEAST_CELL_S, n.cell_s);
        }
    }
    for (std::size_t i = 1; i < nodes_.size(); ++i) {
        Node &a = nodes_[i - 1], &b = nodes_[i];
        const double change = CHANGE_PER_CELL * (b.t - a.t) / std::max(std::abs(b.v - a.v), 1e-300);
        for (Node *n : {&a, &b}) {
            if (n->v > 0) {
                n->cell_s = std::max(std::min(n->cell_s, change * n->v), LEAST_CELL_S);
            }
        }
    }
    for (std::size_t i = 1; i < nodes_.size(); ++i) {
        const Node &a = nodes_[i - 1];
        nodes_[i].cell_s = std::min(nodes_[i].cell_s, a.cell_s + CELL_GROWTH * (nodes_[i].t - a.t));
    }
    counts_.assign(nodes_.size(), 0.0);
    for (std::size_t i = nodes_.size() - 1; i-- > 0;) {
        const Node &b = nodes_[i + 1];
        nodes_[i].cell_s = std::min(nodes_[i].cell_s, b.cell_s + CELL_GROWTH * (b.t - nodes_[i].t));
    }
    for (std::size_t i = 1; i < nodes_.size(); ++i) {
        counts_[i] = counts_[i - 1] + count_between(nodes_[i - 1], nodes_[i], nodes_[i].t);
    }
}

/// Number of cells from node `a` to the time `t`, which is before node `b`. The time of a cell changes
/// linearly.
double RoughProfile::count_between(const Node &a, const Node &b, double t) noexcept {
    const double passed = t - a.t, rise = (b.cell_s - a.cell_s) / std::max(b.t - a.t, 1e-300);
    const double x = rise * passed / a.cell_s;
    return std::abs(x) < 1e-6 ? passed / a.cell_s * (1 - 0.5 * x) : std::log1p(x) / rise;
}

/// The time at which `count` cells after the node `a` end.
double RoughProfile::time_after(const Node &a, const Node &b, double count) noexcept {
    const double rise = (b.cell_s - a.cell_s) / std::max(b.t - a.t, 1e-300);
    const double x = rise * count;
    return a.t + a.cell_s * count * (std::abs(x) < 1e-6 ? 1 + 0.5 * x : std::expm1(x) / x);
}

void RoughProfile::lay_knots(const Run &run, const Stretch &stretch) {
    for (std::size_t i = 1; i < nodes_.size(); ++i) {
        const Node &a = nodes_[i - 1];
        Node &b = nodes_[i];
        b.t = a.t + (std::min(a.v, b.v) == 0 ? 3.0 : 2.0) * (b.s - a.s) / (a.v + b.v);
    }
    size_cells(run, stretch);
    const double whole = nodes_.back().t;
    const double left = time_left(stretch);
    const auto last =
        std::find_if(nodes_.begin(), nodes_.end(), [&](const Node &n) { return n.t >= left + n.cell_s; });
    const bool is_all = reaches_end_ && counts_.back() < MOST_CELLS &&
                        (last == nodes_.end() || isInEnd(run, stretch, last->s));
    finer_ = is_all ? std::clamp(FEWEST_CELLS / counts_.back(), 1.0,
                                 std::max(1.0, whole / (LEAST_CELL_S * counts_.back())))
                    : 1.0;
    std::size_t node = 1;
    const double most = std::min(counts_.back(), static_cast<double>(MOST_CELLS));
    const double time = is_all ? whole : std::min({whole, left, time_at(most, node)});
    // A cell ends at the first node of each cap. Because of rounding, there may be several nodes of a cap.
    double from = 0, last_cap = nodes_[0].cap_s;
    node = 1;
    for (std::size_t i = 1; i < nodes_.size() && nodes_[i].t < time; ++i) {
        if (nodes_[i].cap_s > NOWHERE && nodes_[i].cap_s != last_cap) {
            last_cap = nodes_[i].cap_s;
            lay_between(from, counts_[i], node);
            knots_.back().s = nodes_[i].s;
            from = counts_[i];
        }
    }
    const double end = is_all ? counts_.back() : count_at(time);
    if (is_all || end - from > 0.5) {
        lay_between(from, end, node);
    }
    if (is_all) {
        knots_.back().s = nodes_.back().s;
    }
}

/// Number of cells up to the time `t`.
double RoughProfile::count_at(double t) const noexcept {
    const auto behind =
        std::partition_point(nodes_.begin() + 1, nodes_.end() - 1, [&](const Node &n) { return n.t < t; });
    const auto i = static_cast<std::size_t>(behind - nodes_.begin());
    return counts_[i - 1] + count_between(nodes_[i - 1], nodes_[i], std::min(t, nodes_[i].t));
}

/// The time at which `count` cells end. `node`: a node at or before this time; it is updated.
double RoughProfile::time_at(double count, std::size_t &node) const noexcept {
    while (node + 1 < nodes_.size() && counts_[node] < count) {
        ++node;
    }
    return std::min(time_after(nodes_[node - 1], nodes_[node], count - counts_[node - 1]), nodes_[node].t);
}

/// Makes cells of constant or slowly changing time between two counts. `node`: a node at or before the first
/// cell; it is updated.
void RoughProfile::lay_between(double from, double to, std::size_t &node) {
    const auto cells = static_cast<std::size_t>(std::max(1.0, std::ceil(finer_ * (to - from))));
    double before = time_at(from, node);
    for (std::size_t k = 1; k <= cells; ++k) {
        const double t =
            time_at(from + (to - from) * static_cast<double>(k) / static_cast<double>(cells), node);
        const Node &a = nodes_[node - 1];
        const Node &b = nodes_[node];
        const double x = std::clamp((t - a.t) / (b.t - a.t), 0.0, 1.0);
        const double y = 1 - x;
        const double s = a.v == 0   ? a.s + (b.s - a.s) * x * x * x
                         : b.v == 0 ? b.s - (b.s - a.s) * y * y * y
                                    : a.s + x * (b.t - a.t) * (a.v + 0.5 * (b.v - a.v) * x);
        knots_.push_back({s, t - before});
        before = t;
    }
}

}  // namespace mw::trajectory::profile

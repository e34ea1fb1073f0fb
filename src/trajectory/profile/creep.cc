// SPDX-License-Identifier: GPL-2.0-or-later
// Coefficients of new cells: a creep, which is so slow that it is far within every limit.
#include <algorithm>
#include <cmath>

#include "trajectory/curve/curve_builder.hh"
#include "trajectory/profile/cells.hh"
#include "trajectory/profile/joint_speeds.hh"
#include "trajectory/profile/rows.hh"

namespace mw::trajectory::profile {

namespace {

using curve::SPACING_GROWTH;

/// Minimum limits of the motion along the path over all directions.
Bounds least_of(const Run &run) noexcept {
    Bounds least = run.limits.xyz;
    const auto take = [&](const Bounds &b, double first) {
        least.velocity = std::min(least.velocity, b.velocity / first);
        least.acceleration = std::min(least.acceleration, b.acceleration / first);
        least.jerk = std::min(least.jerk, b.jerk / first);
    };
    for (const Bounds &b : run.limits.axes) {
        take(b, 1);
    }
    const std::size_t joints = run.joint_curve == nullptr ? 0 : run.joint_curve->joints();
    for (std::size_t j = 0; j < joints; ++j) {
        take(bounds_of(run.joints, j), std::max(run.joint_curve->largest_first()[j], 1e-30));
    }
    return least;
}

/// Speed of a creep divided by the speed at which the path alone uses the jerk or the acceleration limit.
constexpr double SHARE = 0.15;

/// The scale of a path whose shape alone uses a limit at the speed v.
double scale_of_creep(const Bounds &least, double v) noexcept {
    return std::max(std::sqrt(v * v * v / least.jerk), v * v / least.acceleration);
}

/// Number of cells after the last one that the last coefficient may affect.
constexpr std::size_t CELLS_BEHIND = 2;
/// Minimum number of stretches of a creep per scale of the path. The slope of the speed changes over a
/// stretch. Shorter stretches would use more of the jerk.
constexpr double STRETCHES = 50;

/// The scale of the path, of its map and of its speed limits as a function of s. It is the minimum over all
/// positions, each with the growth of the scale over the distance from there. Cells only sample it, so it
/// does not depend on the division into cells. When more of the path is known, it only grows.
class Scales {
  public:
    Scales(const Run &run, const Bounds &least)
        : run_(run), least_(least), feeds_(run.has_stop ? run.feed_at(run.end_s) + 1 : run.feeds->size()) {}

    /// The scale of an existing cell.
    struct Known {
        std::size_t cell = 0;
        double scale = 1e300, speed = 1e300;
    };
    void find(const RestMap &map, const std::vector<double> &knots, double end_ramp, const Known &known) {
        knots_ = knots;
        const double h = knots.back() - knots[knots.size() - 2];
        for (std::size_t i = 0; i < CELLS_BEHIND; ++i) {
            knots_.push_back(knots_.back() + h);
        }
        take_cells(map, end_ramp);
        cells_[known.cell] = std::min(cells_[known.cell], known.scale);
        if (run_.joint_curve != nullptr) {
            const std::vector<double> &speed =
                joint_speeds_.find(*run_.joint_curve, map, knots_, {known.cell, known.speed});
            for (std::size_t k = 0; k < cells_.size(); ++k) {
                cells_[k] = std::min(cells_[k], scale_of_creep(least_, speed[k]));
            }
        }
        spread();
    }
    /// The scale at the end of a cell.
    double at(std::size_t knot) const noexcept { return at_[knot]; }
    /// The minimum scale between two knots.
    double least_between(std::size_t from, std::size_t to) const noexcept {
        return *std::min_element(at_.begin() + static_cast<long>(from),
                                 at_.begin() + static_cast<long>(std::min(to, at_.size() - 1)) + 1);
    }

  private:
    /// The maximum speed of a move. A move with speed 0 is not executed: the motion stops before it.
    double speed_of(const FeedLimit &feed) const noexcept {
        const double v = std::min(feed.limit_share * least_.velocity, feed.velocity);
        return v > 0 ? v : 1e300;
    }
    /// The scale at which the jerk limit allows this speed.
    double scale_of_speed(double v) const noexcept { return std::sqrt(v * v * v / least_.jerk); }

    /// Calculates the minimum scale in each cell. It includes short spans and moves between the points where
    /// limits are checked.
    void take_cells(const RestMap &map, double end_ramp) {
        const auto &spans = *run_.spans;
        cells_.resize(knots_.size() - 1);
        double s = map.at(knots_[0]).s;
        std::size_t span = span_at(spans, s), feed = run_.feed_at(s);
        for (std::size_t k = 0; k < cells_.size(); ++k) {
            const double from = s;
            s = map.at(knots_[k + 1]).s;
            double length = spans[span].length;
            while (span + 1 < spans.size() && s >= spans[span].end_s()) {
                length = std::min(length, spans[++span].length);
            }
            double v = speed_of((*run_.feeds)[feed]);
            while (feed + 1 < feeds_ && s >= (*run_.feeds)[feed].end_s) {
                v = std::min(v, speed_of((*run_.feeds)[++feed]));
            }
            run_.each_cap(from, s, [&](const SpeedCap &cap) { v = std::min(v, cap.v); });
            const double before_stop =
                RestMap::scale_of(end_ramp) + SPACING_GROWTH * std::max(0.0, run_.end_s - end_ramp - s);
            cells_[k] = std::min({length, map.scale_at(knots_[k]), map.scale_at(knots_[k + 1]), before_stop,
                                  scale_of_speed(v)});
        }
        look_ahead(s, span, feed);
    }

    /// Reduces the scale of the last cell, which ends at s, because of smaller scales after it.
    void look_ahead(double s, std::size_t span, std::size_t feed) {
        double &last = cells_.back();
        const auto &spans = *run_.spans;
        for (std::size_t j = span + 1; j < spans.size() && SPACING_GROWTH * (spans[j].start_s - s) < last;
             ++j) {
            last = std::min(last, spans[j].length + SPACING_GROWTH * std::max(0.0, spans[j].start_s - s));
        }
        const auto apart = [&](std::size_t j) { return (*run_.feeds)[j - 1].end_s - s; };
        for (std::size_t j = feed + 1; j < feeds_ && SPACING_GROWTH * apart(j) < last; ++j) {
            last = std::min(last, scale_of_speed(speed_of((*run_.feeds)[j])) +
                                      SPACING_GROWTH * std::max(0.0, apart(j)));
        }
        for (std::size_t j = run_.joint_curve == nullptr ? 0 : run_.joint_curve->part_at(s);
             run_.joint_curve != nullptr && j < run_.joint_curve->parts().size(); ++j) {
            const curve::JointCurve::Part &part = run_.joint_curve->parts()[j];
            const double distance = std::max(0.0, part.start_s - s);
            if (SPACING_GROWTH * distance >= last) {
                break;
            }
            last = std::min(last, scale_of_creep(least_, part.speed) + SPACING_GROWTH * distance);
        }
        run_.each_cap(s, s + last / SPACING_GROWTH, [&](const SpeedCap &cap) {
            last =
                std::min(last, scale_of_speed(cap.v) + SPACING_GROWTH * std::max(0.0, cap.s - cap.reach - s));
        });
    }

    /// Calculates the scale at the ends of the cells.
    void spread() {
        at_.assign(knots_.size(), 1e300);
        for (std::size_t k = 0; k < cells_.size(); ++k) {
            at_[k] = std::min(at_[k], cells_[k]);
            at_[k + 1] = std::min(cells_[k], at_[k] + SPACING_GROWTH * (knots_[k + 1] - knots_[k]));
        }
        for (std::size_t k = cells_.size(); k-- > 0;) {
            at_[k] = std::min(at_[k], at_[k + 1] + SPACING_GROWTH * (knots_[k + 1] - knots_[k]));
        }
    }

    const Run &run_;
    const Bounds &least_;
    std::size_t feeds_;  ///< number of the feeds before the stop
    std::vector<double> knots_, cells_, at_;
    JointSpeeds joint_speeds_;
};

/// A creep from a position on: a spline on stretches of cells. Each coefficient corresponds to the minimum
/// scale of the stretches around it. Cells are parts of stretches, so the motion does not depend on their
/// lengths.
class CreepSpline {
  public:
    CreepSpline(const std::vector<double> &knots, const Scales &scales, const Bounds &least)
        : knots_(knots), scales_(scales), least_(least) {}

    /// Calculates the coefficients. `start`: state at the knot `from` if the motion exists there. `fall`:
    /// maximum slope at which the scale falls, as lowered limits and longer cells need it. False if the end
    /// is above the scale there.
    bool lay(std::size_t from, const LawState *start, double fall) {
        cut(from);
        const double h = length(0);
        std::size_t k = 0;
        if (start != nullptr) {
            c_ = {start->b - start->a * h, start->b + start->a * h};
            k = 2;
        } else {
            c_.clear();
        }
        const double known = k > 0 ? scale_of_creep(least_, std::sqrt(c_[1]) / SHARE) : 0;
        bool is_reached = true;
        for (; k < ends_.size() + 1; ++k) {
            const std::size_t before = ends_[std::max<std::size_t>(k, 2) - 2];
            const std::size_t behind = k + 1 < ends_.size() ? ends_[k + 1] : ends_.back() + CELLS_BEHIND;
            double d = scales_.least_between(before, behind);
            if (start != nullptr) {
                const double distance = middle(k) - middle(1), least = known - fall * distance;
                is_reached = d >= least;
                d = std::clamp(d, least, known + SPACING_GROWTH * distance);
            }
            const double v =
                SHARE * std::min(std::cbrt(least_.jerk * d * d), std::sqrt(least_.acceleration * d));
            c_.push_back(v * v);
        }
        return is_reached;
    }
    /// The coefficient of a cell from x to y in stretch k or beside it.
    double coefficient(std::size_t k, double x, double y) const noexcept {
        const double a = slope(k), w = (slope(k + 1) - a) / length(k);
        const double before = length(k > 0 ? k - 1 : 0), h = length(k), p = knots_[ends_[k]];
        const double b = (h * c_[k] + before * c_[k + 1]) / (before + h);
        return b + a * (x - p + y - p) + w * (x - p) * (y - p);
    }
    std::size_t stretches() const noexcept { return ends_.size() - 1; }
    /// Index of the knot at which a stretch ends.
    std::size_t end_of(std::size_t k) const noexcept { return ends_[k + 1]; }

  private:
    /// Divides the cells into stretches.
    void cut(std::size_t from) {
        const std::size_t last = knots_.size() - 1;
        ends_.assign(1, from);
        for (std::size_t k = from; k < last;) {
            const double least = scales_.at(k) / STRETCHES;
            std::size_t end = k + 1;
            while (end < last && knots_[end] - knots_[k] < least) {
                ++end;
            }
            // A rest that is too short for a separate stretch belongs to this stretch.
            k = knots_[last] - knots_[end] < least ? last : end;
            ends_.push_back(k);
        }
    }
    double length(std::size_t k) const noexcept {
        const std::size_t in = std::min(k, stretches() - 1);
        return knots_[ends_[in + 1]] - knots_[ends_[in]];
    }
    double slope(std::size_t k) const noexcept {
        return (c_[k + 1] - c_[k]) / (length(k > 0 ? k - 1 : 0) + length(k));
    }
    /// The middle of the stretch of coefficient k.
    double middle(std::size_t k) const noexcept {
        const std::size_t in = std::clamp<std::size_t>(k, 1, stretches()) - 1;
        return 0.5 * (knots_[ends_[in]] + knots_[ends_[in + 1]]);
    }

    const std::vector<double> &knots_;
    const Scales &scales_;
    const Bounds &least_;
    std::vector<std::size_t> ends_;  ///< indices of knots
    std::vector<double> c_;
};

/// Maximum slope of a falling scale. If the speed of joints changes by a factor over the length of a part, so
/// does the creep. The scale is proportional to the power 3/2 of the speed.
double fall_of(const Run &run, double s, double scale) noexcept {
    constexpr std::size_t PARTS_AHEAD = 3;
    double fall = 2 * SPACING_GROWTH;
    if (run.joint_curve == nullptr) {
        return fall;
    }
    const auto &parts = run.joint_curve->parts();
    const std::size_t at = run.joint_curve->part_at(s);
    for (std::size_t k = at; k + 1 < std::min(parts.size(), at + PARTS_AHEAD + 1); ++k) {
        const double change = std::min(1.0, std::abs(std::log(parts[k + 1].speed / parts[k].speed)));
        const double length = std::min(parts[k].length, parts[k + 1].length);
        fall = std::min(fall, 1.5 * scale / std::max(length * change, 1e-300));
    }
    return fall;
}

}  // namespace

double creep_scale(const Run &run, double c) noexcept {
    return scale_of_creep(least_of(run), std::sqrt(c) / SHARE);
}

bool isSteady(const Run &run, double c, double next, double apart) noexcept {
    return std::abs(creep_scale(run, next) - creep_scale(run, c)) <= SPACING_GROWTH * apart;
}

bool creep(const Run &run, const RestMap &map, const std::vector<double> &knots, double end_ramp,
           std::vector<double> &c) {
    const Bounds least = least_of(run);
    Scales scales(run, least);
    const std::size_t cells = knots.size() - 1;
    const std::size_t from = c.empty() ? 0 : c.size() - 2;
    const auto length = [&](std::size_t k) { return knots[k + 1] - knots[k]; };
    LawState start;
    Scales::Known known;
    if (!c.empty()) {
        const double before = length(from - 1), behind = length(from), last = c[from], next = c[from + 1];
        start.a = (next - last) / (before + behind);
        start.b = last + start.a * before;
        const double v = std::sqrt(next) / SHARE;
        known = {from, scale_of_creep(least, v), v};
    }
    scales.find(map, knots, end_ramp, known);
    CreepSpline spline(knots, scales, least);
    const bool is_reached =
        spline.lay(from, c.empty() ? nullptr : &start, fall_of(run, map.at(knots[from]).s, known.scale));
    if (c.empty()) {
        c.push_back(spline.coefficient(0, knots[0] - length(0), knots[0]));
    }
    for (std::size_t k = 0, cell = c.size() - 1; k < spline.stretches(); ++k) {
        for (; cell < spline.end_of(k); ++cell) {
            c.push_back(spline.coefficient(k, knots[cell], knots[cell + 1]));
        }
    }
    // The last coefficient belongs to a cell of the same length after the end.
    c.push_back(2 * spline.coefficient(spline.stretches() - 1, knots[cells], knots[cells]) - c[cells]);
    return is_reached;
}

}  // namespace mw::trajectory::profile

// SPDX-License-Identifier: GPL-2.0-or-later
// Coefficients of cells that have none: a motion so slow that it keeps every limit by far.
#include <algorithm>
#include <cmath>

#include "trajectory/curve/curve_builder.hh"
#include "trajectory/profile/cells.hh"
#include "trajectory/profile/joint_speeds.hh"

namespace mw::trajectory::profile {

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

/// Speed of a creep over that at which the path alone takes all of the jerk or of the acceleration.
constexpr double SHARE = 0.15;

/// The scale of the path at which it alone takes a limit at the speed v.
double scale_of_creep(const Bounds &least, double v) noexcept {
    return std::max(std::sqrt(v * v * v / least.jerk), v * v / least.acceleration);
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
                scale_[k] = std::min(scale_[k], scale_of_creep(least_, speed[k]));
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
        for (std::size_t j = run_.joint_curve == nullptr ? 0 : run_.joint_curve->part_at(s);
             run_.joint_curve != nullptr && j < run_.joint_curve->parts().size(); ++j) {
            const curve::JointCurve::Part &part = run_.joint_curve->parts()[j];
            const double way = std::max(0.0, part.start_s - s);
            if (SPACING_GROWTH * way >= last) {
                break;
            }
            last = std::min(last, scale_of_creep(least_, part.speed) + SPACING_GROWTH * way);
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

double creep_scale(const Run &run, double c) noexcept {
    return scale_of_creep(least_of(run.limits), std::sqrt(c) / SHARE);
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
    const double from = old == 0 ? 0 : scale_of_creep(least, std::sqrt(c.back()) / SHARE);
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
        const double v = SHARE * std::min(std::cbrt(least.jerk * d * d), std::sqrt(least.acceleration * d));
        c.push_back(v * v);
    }
}

}  // namespace mw::trajectory::profile

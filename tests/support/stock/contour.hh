// SPDX-License-Identifier: GPL-2.0-or-later
// A contour as defined by its generator: u along the cut, h away from the part. Lengths in mm.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace mw::testing {

struct Place {
    double u = 0, h = 0;
};

inline double span(Place a, Place b) {
    return std::hypot(b.u - a.u, b.h - a.h);
}

/// A line, or an arc around `centre`.
struct Stroke {
    Place from, to;
    bool isArc = false;
    Place centre;
    bool isCounterclockwise = false;

    double radius() const { return span(centre, from); }
    double angle_of(Place p) const { return std::atan2(p.h - centre.h, p.u - centre.u); }
    /// Angle of the arc up to `p`, 0 to a full turn [rad].
    double turned(Place p) const {
        const double way = (angle_of(p) - angle_of(from)) * (isCounterclockwise ? 1.0 : -1.0);
        return way - 2.0 * std::numbers::pi * std::floor(way / (2.0 * std::numbers::pi));
    }
    /// The point after the fraction `t` of the piece.
    Place at(double t) const {
        if (!isArc) {
            return {from.u + t * (to.u - from.u), from.h + t * (to.h - from.h)};
        }
        const double angle = angle_of(from) + t * turned(to) * (isCounterclockwise ? 1.0 : -1.0);
        const double r = radius() + t * (span(centre, to) - radius());
        return {centre.u + r * std::cos(angle), centre.h + r * std::sin(angle)};
    }
    double length() const { return isArc ? radius() * turned(to) : span(from, to); }
    double distance(Place p) const {
        const double ends = std::fmin(span(p, from), span(p, to));
        if (isArc) {
            return turned(p) <= turned(to) ? std::fmin(ends, std::fabs(span(p, centre) - radius())) : ends;
        }
        const double l2 = (to.u - from.u) * (to.u - from.u) + (to.h - from.h) * (to.h - from.h);
        if (l2 == 0.0) {
            return ends;
        }
        const double t = ((p.u - from.u) * (to.u - from.u) + (p.h - from.h) * (to.h - from.h)) / l2;
        return t <= 0.0 || t >= 1.0 ? ends : span(p, at(t));
    }
};

/// The outline of a part; the material is below it.
struct Contour {
    std::vector<Stroke> strokes;

    Place first() const { return strokes.front().from; }
    Place last() const { return strokes.back().to; }
    /// The height of the material at `u`; far below outside the contour.
    double height(double u) const {
        double best = -1e9;
        for (const Stroke &s : strokes) {
            if (u < s.from.u || u > s.to.u) {
                continue;
            }
            if (s.to.u - s.from.u < 1e-9) {
                best = std::max({best, s.from.h, s.to.h});
            } else if (!s.isArc) {
                best = std::max(best, s.at((u - s.from.u) / (s.to.u - s.from.u)).h);
            } else {
                const double r = s.radius(), aside = u - s.centre.u;
                const double rise = std::sqrt(std::fmax(0.0, r * r - aside * aside));
                best = std::max(best, s.isCounterclockwise ? s.centre.h - rise : s.centre.h + rise);
            }
        }
        return best;
    }
    /// Distance from the outline, on either side.
    double distance(Place p) const {
        double best = 1e9;
        for (const Stroke &s : strokes) {
            best = std::fmin(best, s.distance(p));
        }
        return best;
    }
    /// Distance from the material; negative inside it.
    double clearance(Place p) const { return p.h < height(p.u) ? -distance(p) : distance(p); }
    /// Its highest point, up to `u`.
    double highest(double u = 1e9) const {
        double best = height(u);
        for (const Stroke &s : strokes) {
            if (s.from.u > u) {
                continue;
            }
            best = std::max({best, s.from.h, s.to.u <= u ? s.to.h : s.from.h});
            const bool isOverCentre = s.isArc && !s.isCounterclockwise && s.from.u <= s.centre.u &&
                                      s.to.u >= s.centre.u && s.centre.u <= u;
            best = isOverCentre ? std::fmax(best, s.centre.h + s.radius()) : best;
        }
        return best;
    }
};

}  // namespace mw::testing

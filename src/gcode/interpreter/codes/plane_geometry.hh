// SPDX-License-Identifier: GPL-2.0-or-later
// Points, lines and circles in a plane, for cutter compensation and lathe cycles.
#pragma once

#include <cmath>

namespace mw::gcode::detail {

/// A point or vector in a plane, along its first and second axis.
struct Point {
    double x = 0, y = 0;

    bool operator==(const Point &) const = default;
};

constexpr double SAME_POINT = 1e-10;

inline double dot(Point a, Point b) {
    return a.x * b.x + a.y * b.y;
}

inline double cross(Point a, Point b) {
    return a.x * b.y - a.y * b.x;
}

inline Point sum(Point a, Point b, double scale) {
    return {a.x + b.x * scale, a.y + b.y * scale};
}

inline double distance(Point a, Point b) {
    return std::hypot(b.x - a.x, b.y - a.y);
}

inline Point unit(Point from, Point to) {
    const double length = distance(from, to);
    return {(to.x - from.x) / length, (to.y - from.y) / length};
}

/// Intersections of two paths: none, one or two points.
struct Crossings {
    int count = 0;
    Point points[2];
};

/// Intersections of a line, by a point and its direction, and a circle.
inline Crossings cross_line_circle(Point on_line, Point along, Point centre, double radius) {
    const Point foot = sum(on_line, along, dot({centre.x - on_line.x, centre.y - on_line.y}, along));
    const double off = distance(foot, centre);
    if (off > radius + SAME_POINT) {
        return {};
    }
    const double half = std::sqrt(std::fmax(0.0, radius * radius - off * off));
    return {2, {sum(foot, along, half), sum(foot, along, -half)}};
}

inline Crossings cross_circles(Point c1, double r1, Point c2, double r2) {
    const double apart = distance(c1, c2);
    if (apart < SAME_POINT || apart > r1 + r2 + SAME_POINT || apart < std::fabs(r1 - r2) - SAME_POINT) {
        return {};
    }
    const Point along = unit(c1, c2);
    const double at = (apart * apart + r1 * r1 - r2 * r2) / (2.0 * apart);
    const double half = std::sqrt(std::fmax(0.0, r1 * r1 - at * at));
    const Point foot = sum(c1, along, at), across{-along.y, along.x};
    return {2, {sum(foot, across, half), sum(foot, across, -half)}};
}

}  // namespace mw::gcode::detail

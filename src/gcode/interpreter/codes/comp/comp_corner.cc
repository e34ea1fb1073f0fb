// SPDX-License-Identifier: GPL-2.0-or-later
#include "gcode/interpreter/codes/comp/comp_corner.hh"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

namespace mw::gcode::detail {
namespace {

constexpr double PI = std::numbers::pi;
constexpr double TINY = 1e-10;
/// Corners with a smaller angle are treated as straight: the tool is nearer to the contour by at most 1/800
/// of its radius. Within this angle of a reversal, the curvature of arcs determines on which side the contour
/// continues. [rad]
constexpr double STRAIGHT_ANGLE = 0.05;
constexpr double STRAIGHT_ERROR = STRAIGHT_ANGLE * STRAIGHT_ANGLE / 2.0;
/// If the notch between a move and an arc is wider than this, it closes far from the corner [rad].
constexpr double CLOSING_ANGLE = 0.3;
/// Corners and arcs with a larger total angle may lead back across the previous move [rad].
constexpr double TIP_ANGLE = PI / 2.0;

Crossings cross_lines(const CompElement &a, const CompElement &b) {
    const double sine = cross(a.start_direction, b.start_direction);
    if (std::fabs(sine) < TINY) {
        return {};
    }
    const Point gap{b.end.x - a.end.x, b.end.y - a.end.y};
    const Point point = sum(a.end, a.start_direction, cross(gap, b.start_direction) / sine);
    return {1, {point, point}};
}

Crossings crossings(const CompElement &a, const CompElement &b) {
    if (a.isArc && b.isArc) {
        return cross_circles(a.centre, a.radius, b.centre, b.radius);
    }
    if (a.isArc) {
        return cross_line_circle(b.end, b.start_direction, a.centre, a.radius);
    }
    if (b.isArc) {
        return cross_line_circle(a.end, a.start_direction, b.centre, b.radius);
    }
    return cross_lines(a, b);
}

/// True if start and end are equal and the arc is a full circle.
bool isCircle(const CompElement &element) {
    return element.isArc && distance(element.from, element.to) < TINY;
}

/// True if the element still runs forward from `start` to `end`. The remaining arc must be long enough not to
/// be taken for a full circle.
bool isForward(const CompElement &element, Point start, Point end, double slack) {
    if (!element.isArc) {
        return dot({end.x - start.x, end.y - start.y}, element.start_direction) > -TINY;
    }
    constexpr double LEAST = 1e-8;
    const double left = comp_sweep(element, start, end);
    return left > LEAST && (isCircle(element) || left <= comp_sweep(element, element.start, element.end) +
                                                             std::fmin(0.05, slack / element.radius));
}

/// True if a move from `from` to `to` follows the element, on an arc by at most 180 degrees. It may go back
/// by `slack`, because coordinates are rounded.
bool isAlong(const CompElement &element, Point from, Point to, double slack) {
    if (!element.isArc) {
        return dot({to.x - from.x, to.y - from.y}, element.start_direction) > -slack;
    }
    const double sweep = comp_sweep(element, from, to);
    return sweep <= PI || (2.0 * PI - sweep) * element.radius < slack;
}

/// The intersection nearest to the programmed corner that shortens both elements without removing one of
/// them.
std::optional<Point> cut_corner(const CompElement &last, const CompElement &next, Point corner,
                                const CornerTool &tool) {
    // Rounded coordinates shift an intersection at a small angle by a multiple of the rounding error.
    const double slack = std::fmin(0.5 * tool.radius, 0.1 * tool.radius + 20.0 * tool.rounding);
    const Crossings found = crossings(last, next);
    std::optional<Point> best;
    double least = 0.0;
    for (int i = 0; i < found.count; ++i) {
        const Point point = found.points[i];
        const double far = distance(point, corner);
        const bool usable =
            isAlong(last, point, last.end, slack) && isAlong(next, next.start, point, slack) &&
            isForward(last, last.start, point, slack) && isForward(next, point, next.end, slack);
        if (usable && (!best || far < least)) {
            best = point;
            least = far;
        }
    }
    return best;
}

/// Signed, positive to the left of the direction of travel.
double programmed_curvature(const CompElement &element) {
    return element.isArc ? std::copysign(1.0 / distance(element.centre, element.to), element.rotation) : 0.0;
}

/// Distance of `point` from the path of the tool centre along the element.
double distance_to(const CompElement &element, Point start, Point point) {
    const double ends = std::fmin(distance(point, start), distance(point, element.end));
    if (element.isArc) {
        const bool beside = isCircle(element) || comp_sweep(element, start, point) <=
                                                     comp_sweep(element, start, element.end) + TINY;
        const double off = std::fabs(distance(element.centre, point) - element.radius);
        return beside ? std::fmin(ends, off) : ends;
    }
    const double length = distance(start, element.end);
    if (length < TINY) {
        return ends;
    }
    const Point along = unit(start, element.end);
    const Point gap{point.x - start.x, point.y - start.y};
    const double at = dot(gap, along);
    return at > 0.0 && at < length ? std::fmin(ends, std::fabs(cross(along, gap))) : ends;
}

/// Difference of the distances of the arc's start and end from its centre; positive if the end is nearer.
double radius_error(const CompElement &element) {
    return element.isArc ? distance(element.centre, element.from) - distance(element.centre, element.to)
                         : 0.0;
}

/// Angle of the programmed move, in either direction [rad].
double programmed_sweep(const CompElement &element) {
    if (!element.isArc) {
        return 0.0;
    }
    return isCircle(element) ? 2.0 * PI : comp_sweep(element, element.from, element.to);
}

/// A point of the programmed move: 0 at its start, 1 at its end.
Point programmed_at(const CompElement &element, double share) {
    if (!element.isArc) {
        return {element.from.x + (element.to.x - element.from.x) * share,
                element.from.y + (element.to.y - element.from.y) * share};
    }
    const double angle = std::copysign(programmed_sweep(element) * share, element.rotation);
    const Point arm{element.from.x - element.centre.x, element.from.y - element.centre.y};
    const double c = std::cos(angle), s = std::sin(angle);
    return {element.centre.x + arm.x * c - arm.y * s, element.centre.y + arm.x * s + arm.y * c};
}

/// The element with the programmed path instead of the tool path.
CompElement programmed(const CompElement &element) {
    CompElement out = element;
    out.start = element.from;
    out.end = element.to;
    out.radius = element.isArc ? distance(element.centre, element.to) : 0.0;
    return out;
}

/// Tool centre at the start of the programmed move.
Point offset_start(const CompElement &element, const CornerTool &tool) {
    if (element.isArc) {
        return sum(element.centre, unit(element.centre, element.from), element.radius);
    }
    return sum(element.from, side_normal(tool.side, element.start_direction), tool.radius);
}

/// True if the tool cuts into one of the two moves on its path along the other, or around the corner between
/// them.
bool isTouching(const CompElement &last, const CompElement &next, const CornerTool &tool) {
    const bool has_arc = last.isArc || next.isArc;
    const double off = std::fabs(radius_error(last)) + std::fabs(radius_error(next));
    const double least = tool.radius - (has_arc ? tool.tolerance : tool.rounding) - off;
    const CompElement contours[] = {programmed(last), programmed(next)};
    // A start that was shifted at a nearly straight corner is not used here.
    const Point begun = offset_start(last, tool);
    const Point start = distance(begun, last.start) < 1.2 * STRAIGHT_ANGLE * tool.radius ? begun : last.start;
    const Point a = unit(next.from, last.end), b = unit(next.from, next.start);
    const double turn =
        std::copysign(std::atan2(cross(a, b), dot(a, b)), tool.side == CompSide::LEFT ? -1.0 : 1.0);
    constexpr int SAMPLES = 64;  // denser near the corner
    for (int i = 1; i <= SAMPLES; ++i) {
        const double ratio = static_cast<double>(i) / SAMPLES, share = ratio * ratio;
        const double c = std::cos(turn * ratio), s = std::sin(turn * ratio);
        const Point around = sum(next.from, {a.x * c - a.y * s, a.x * s + a.y * c}, tool.radius);
        if (distance_to(last, start, programmed_at(next, share)) < least ||
            distance_to(next, next.start, programmed_at(last, 1.0 - share)) < least ||
            distance_to(contours[0], last.from, around) < least ||
            distance_to(contours[1], next.from, around) < least) {
            return true;
        }
    }
    return false;
}

/// True if the corner angle is so small that the next move may begin at the end of the last one.
bool isNearlyStraight(const CompElement &last, const CompElement &next, double turn, double radius) {
    if (std::fabs(turn) > STRAIGHT_ANGLE) {
        return false;
    }
    if (!next.isArc) {
        return dot({next.end.x - last.end.x, next.end.y - last.end.y}, next.start_direction) > -TINY;
    }
    // The start may be off the arc by slightly more than the rounding of coordinates.
    const double off = distance(next.centre, last.end) - next.radius - radius_error(next);
    if (std::fabs(off) > STRAIGHT_ERROR * radius + TINY) {
        return false;
    }
    return turn <= 0.0 || isCircle(next) || isForward(next, last.end, next.end, TINY);
}

}  // namespace

Point side_normal(CompSide side, Point direction) {
    return side == CompSide::LEFT ? Point{-direction.y, direction.x} : Point{direction.y, -direction.x};
}

double comp_sweep(const CompElement &arc, Point from, Point to) {
    const Point a{from.x - arc.centre.x, from.y - arc.centre.y}, b{to.x - arc.centre.x, to.y - arc.centre.y};
    const double angle = std::atan2(cross(a, b), dot(a, b)) * (arc.rotation > 0 ? 1.0 : -1.0);
    return angle < -TINY ? angle + 2.0 * PI : angle;
}

Corner decide_corner(const CompElement &last, const CompElement &next, Point corner, const CornerTool &tool) {
    const double angle = std::atan2(cross(last.end_direction, next.start_direction),
                                    dot(last.end_direction, next.start_direction));
    const double turn = tool.side == CompSide::LEFT ? angle : -angle;  // > 0: towards the tool
    if (tool.radius < TINY || isNearlyStraight(last, next, turn, tool.radius)) {
        return {};
    }
    const double from_reversal = PI - std::fabs(angle);
    const bool has_arc = last.isArc || next.isArc;
    double bend = programmed_curvature(last) + programmed_curvature(next);
    bend = tool.side == CompSide::LEFT ? -bend : bend;  // > 0: the return path curves towards the tool
    constexpr double EXACT = 1e-6;
    const bool bent = has_arc && std::fabs(bend) > TINY && from_reversal < STRAIGHT_ANGLE;
    const bool retraced = !bent && from_reversal < EXACT;
    const bool concave = bent ? bend > 0.0 : !retraced && turn > 0.0;
    const bool may_go_around = !concave || turn <= 0.0;
    const double turned = std::fabs(turn) + programmed_sweep(last) + programmed_sweep(next);
    const bool sharp = has_arc && !last.is_entry && (turned > TIP_ANGLE || bent);

    std::optional<Point> cut = concave ? cut_corner(last, next, corner, tool) : std::nullopt;
    if (!cut && may_go_around && !(sharp && isTouching(last, next, tool))) {
        return {CornerKind::AROUND, {}};
    }
    const double notch = from_reversal * from_reversal / (2.0 * bend);
    const bool notch_small = bend > TINY && from_reversal < CLOSING_ANGLE && notch < tool.tolerance;
    if (!cut && (turn > 0.0 || (has_arc && notch_small))) {
        cut = cut_corner(last, next, corner, tool);
        // The notch between the two elements may close near the corner.
        const bool may_close = (!has_arc || bend < 0.0) && from_reversal < CLOSING_ANGLE && !last.is_entry;
        if (!cut && turn > 0.0 && may_close && !bent && !isTouching(last, next, tool)) {
            return {CornerKind::AROUND, {}};
        }
    }
    return cut ? Corner{CornerKind::CUT, *cut} : Corner{CornerKind::BLOCKED, {}};
}

}  // namespace mw::gcode::detail

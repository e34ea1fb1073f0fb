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
/// Corners turning by less than this are passed as if straight: the tool comes nearer by 1/800 of its radius.
/// So near to a reversal it is the curvature of arcs that says on which side the contour goes on. [rad]
constexpr double STRAIGHT_ANGLE = 0.05;
constexpr double STRAIGHT_ERROR = STRAIGHT_ANGLE * STRAIGHT_ANGLE / 2.0;
/// A notch between a move and an arc that is wider than this closes far from the corner [rad].
constexpr double CLOSING_ANGLE = 0.3;
/// Corners and arcs that turn by more than this in all may lead back across the move before [rad].
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

/// Whether begin and end are the same place and the arc a whole circle.
bool isCircle(const CompElement &element) {
    return element.isArc && distance(element.from, element.to) < TINY;
}

/// Whether the element, ended or begun elsewhere, still runs forwards from `start` to `end`. What is left of
/// an arc must be long enough not to be taken for a whole circle.
bool isForward(const CompElement &element, Point start, Point end, double slack) {
    if (!element.isArc) {
        return dot({end.x - start.x, end.y - start.y}, element.start_direction) > -TINY;
    }
    constexpr double LEAST = 1e-8;
    const double left = comp_sweep(element, start, end);
    return left > LEAST && (isCircle(element) || left <= comp_sweep(element, element.start, element.end) +
                                                             std::fmin(0.05, slack / element.radius));
}

/// Whether a move from `from` to `to` goes along the element, on an arc by half a turn at most; back by
/// `slack` at most, as rounded coordinates may have it.
bool isAlong(const CompElement &element, Point from, Point to, double slack) {
    if (!element.isArc) {
        return dot({to.x - from.x, to.y - from.y}, element.start_direction) > -slack;
    }
    const double sweep = comp_sweep(element, from, to);
    return sweep <= PI || (2.0 * PI - sweep) * element.radius < slack;
}

/// The crossing nearest to the programmed corner that shortens both elements and leaves something of them.
std::optional<Point> cut_corner(const CompElement &last, const CompElement &next, Point corner,
                                const CornerTool &tool) {
    // Rounded coordinates move a crossing at a flat angle by many times their rounding.
    const double slack = std::fmin(0.5 * tool.radius, 0.1 * tool.radius + 20.0 * tool.rounding);
    const Crossings found = crossings(last, next);
    std::optional<Point> best;
    double least = 0.0;
    for (int i = 0; i < found.count; ++i) {
        const Point point = found.points[i];
        const double far = distance(point, corner);
        const bool isUsable =
            isAlong(last, point, last.end, slack) && isAlong(next, next.start, point, slack) &&
            isForward(last, last.start, point, slack) && isForward(next, point, next.end, slack);
        if (isUsable && (!best || far < least)) {
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

/// From `point` to where the tool's centre goes along the element.
double distance_to(const CompElement &element, Point start, Point point) {
    const double ends = std::fmin(distance(point, start), distance(point, element.end));
    if (element.isArc) {
        const bool isBeside = isCircle(element) || comp_sweep(element, start, point) <=
                                                       comp_sweep(element, start, element.end) + TINY;
        const double off = std::fabs(distance(element.centre, point) - element.radius);
        return isBeside ? std::fmin(ends, off) : ends;
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

/// How much nearer the end of an arc is to its centre than its beginning.
double radius_error(const CompElement &element) {
    return element.isArc ? distance(element.centre, element.from) - distance(element.centre, element.to)
                         : 0.0;
}

/// How far the programmed move turns, in either direction [rad].
double programmed_sweep(const CompElement &element) {
    if (!element.isArc) {
        return 0.0;
    }
    return isCircle(element) ? 2.0 * PI : comp_sweep(element, element.from, element.to);
}

/// A place of the programmed move: 0 at its begin, 1 at its end.
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

/// The element as it is programmed, in the place of the tool's path.
CompElement programmed(const CompElement &element) {
    CompElement out = element;
    out.start = element.from;
    out.end = element.to;
    out.radius = element.isArc ? distance(element.centre, element.to) : 0.0;
    return out;
}

/// Where the tool's centre is beside the beginning of the programmed move.
Point offset_start(const CompElement &element, const CornerTool &tool) {
    if (element.isArc) {
        return sum(element.centre, unit(element.centre, element.from), element.radius);
    }
    return sum(element.from, side_normal(tool.side, element.start_direction), tool.radius);
}

/// Whether the tool on its way along one of the two moves, or around the corner between them, cuts into the
/// other one.
bool isTouching(const CompElement &last, const CompElement &next, const CornerTool &tool) {
    const bool hasArc = last.isArc || next.isArc;
    const double off = std::fabs(radius_error(last)) + std::fabs(radius_error(next));
    const double least = tool.radius - (hasArc ? tool.tolerance : tool.rounding) - off;
    const CompElement contours[] = {programmed(last), programmed(next)};
    // A start that a nearly straight corner has shifted says nothing of this one.
    const Point begun = offset_start(last, tool);
    const Point start = distance(begun, last.start) < 1.2 * STRAIGHT_ANGLE * tool.radius ? begun : last.start;
    const Point a = unit(next.from, last.end), b = unit(next.from, next.start);
    const double turn =
        std::copysign(std::atan2(cross(a, b), dot(a, b)), tool.side == CompSide::LEFT ? -1.0 : 1.0);
    constexpr int SAMPLES = 64;  // denser towards the corner
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

/// Whether the corner turns so little that the next move may begin where the last one ends.
bool isNearlyStraight(const CompElement &last, const CompElement &next, double turn, double radius) {
    if (std::fabs(turn) > STRAIGHT_ANGLE) {
        return false;
    }
    if (!next.isArc) {
        return dot({next.end.x - last.end.x, next.end.y - last.end.y}, next.start_direction) > -TINY;
    }
    // The start may be as far off the arc as rounded coordinates put it, and hardly more.
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
    const bool hasArc = last.isArc || next.isArc;
    double bend = programmed_curvature(last) + programmed_curvature(next);
    bend = tool.side == CompSide::LEFT ? -bend : bend;  // > 0: the way back bends towards the tool
    constexpr double EXACT = 1e-6;
    const bool isBent = hasArc && std::fabs(bend) > TINY && from_reversal < STRAIGHT_ANGLE;
    const bool isRetraced = !isBent && from_reversal < EXACT;
    const bool isConcave = isBent ? bend > 0.0 : !isRetraced && turn > 0.0;
    const bool mayGoAround = !isConcave || turn <= 0.0;
    const double turned = std::fabs(turn) + programmed_sweep(last) + programmed_sweep(next);
    const bool isSharp = hasArc && !last.isEntry && (turned > TIP_ANGLE || isBent);

    std::optional<Point> cut = isConcave ? cut_corner(last, next, corner, tool) : std::nullopt;
    if (!cut && mayGoAround && !(isSharp && isTouching(last, next, tool))) {
        return {CornerKind::AROUND, {}};
    }
    const double notch = from_reversal * from_reversal / (2.0 * bend);
    const bool isNotchSmall = bend > TINY && from_reversal < CLOSING_ANGLE && notch < tool.tolerance;
    if (!cut && (turn > 0.0 || (hasArc && isNotchSmall))) {
        cut = cut_corner(last, next, corner, tool);
        // The notch between the two may be one that closes before it is worth anything.
        const bool mayClose = (!hasArc || bend < 0.0) && from_reversal < CLOSING_ANGLE && !last.isEntry;
        if (!cut && turn > 0.0 && mayClose && !isBent && !isTouching(last, next, tool)) {
            return {CornerKind::AROUND, {}};
        }
    }
    return cut ? Corner{CornerKind::CUT, *cut} : Corner{CornerKind::BLOCKED, {}};
}

}  // namespace mw::gcode::detail

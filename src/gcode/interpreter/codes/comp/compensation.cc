// SPDX-License-Identifier: GPL-2.0-or-later
#include "gcode/interpreter/codes/comp/compensation.hh"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "base/geometry/pose.hh"

namespace mw::gcode::detail {
namespace {

constexpr double TINY = 1e-10;
/// Permitted cut into a contour that reverses at a tip.
constexpr double TIP_TOLERANCE_MM = 0.005, MM_PER_INCH = 25.4;
/// Rounding of coordinates with four decimals.
constexpr double ROUNDING_MM = 0.0005, ROUNDING_INCH = 0.0001;
/// A rapid move around a corner consists of tangents to the circle about it; maximum angle of each.
constexpr double RAPID_TURN = std::numbers::pi / 3.0;

}  // namespace

/// Vector from the nose centre of a lathe tool to its controlled point, for orientation 1 to 8.
Point Compensation::shift(Plane plane) const {
    static constexpr Point SHIFTS[] = {{0, 0}, {1, -1}, {-1, -1}, {-1, 1}, {1, 1},
                                       {1, 0}, {0, -1}, {-1, 0},  {0, 1},  {0, 0}};  // Z, X
    const bool is_lathe = isOn() && plane == Plane::XZ;
    const Point way = SHIFTS[is_lathe ? orientation_ : 0];
    return {way.x * radius_, way.y * radius_};
}

/// The pose with the tool centre at `point`.
Pose Compensation::in_plane(Pose pose, Point point, Plane plane) const {
    const PlaneAxes axes = plane_axes(plane);
    const Point nose = shift(plane);
    pose[axes.first] = point.x + nose.x;
    pose[axes.second] = point.y + nose.y;
    return pose;
}

/// Sends an arc of the tool centre; the other axes end as in `end`.
void Compensation::send_arc(Point to, Point centre, int rotation, const Pose &end, Plane plane,
                            CanonQueue &canon) const {
    const PlaneAxes axes = plane_axes(plane);
    const Point nose = shift(plane);
    const Pose place = in_plane(end, to, plane);
    canon.take(ArcFeed{place[axes.first], place[axes.second], centre.x + nose.x, centre.y + nose.y, rotation,
                       place[axes.normal], place});
}

void Compensation::turn_on(CompSide side, GCode code, double radius, int orientation) {
    side_ = side;
    code_ = code;
    radius_ = radius;
    orientation_ = orientation;
    last_ = {};
}

void Compensation::turn_off() {
    is_exit_ = isHolding();
    side_ = CompSide::OFF;
    code_ = G(40);
    last_ = {};
}

void Compensation::end(CanonQueue &canon) {
    canon.take(ProgramComment{"interpreter: cutter radius compensation off"});
    turn_off();
}

Pose Compensation::compensated(const Pose &position, Plane plane) const {
    return isHolding() ? in_plane(position, last_.end, plane) : position;
}

/// Moves the end of the last move to `end`, also for later moves that do not move in the plane.
void Compensation::end_last_at(Point end, Plane plane, CanonQueue &canon) {
    const PlaneAxes axes = plane_axes(plane);
    const Pose place = in_plane({}, end, plane);
    canon.move_ends(last_.record, {axes.first, place[axes.first]}, {axes.second, place[axes.second]});
    last_.end = end;
}

/// The rapid path around a convex corner, at a distance of at least the tool radius.
void Compensation::send_rapid_around(const CompPlace &place, Point to, Point corner,
                                     CanonQueue &canon) const {
    const Point a = unit(corner, last_.end), b = unit(corner, to);
    const double direction = side_ == CompSide::LEFT ? -1.0 : 1.0;
    double turn = std::atan2(cross(a, b), dot(a, b)) * direction;
    turn = turn < -TINY ? turn + 2.0 * std::numbers::pi : turn;
    const int pieces = std::max(1, static_cast<int>(std::ceil(turn / RAPID_TURN)));
    const double half = direction * turn / (2.0 * pieces);
    const double reach = radius_ / std::cos(half);
    for (int i = 0; i < pieces; ++i) {
        const double angle = half * (2 * i + 1), c = std::cos(angle), s = std::sin(angle);
        const Point way{a.x * c - a.y * s, a.x * s + a.y * c};
        canon.take(StraightTraverse{in_plane(place.position, sum(corner, way, reach), place.plane)});
    }
    canon.take(StraightTraverse{in_plane(place.position, to, place.plane)});
}

/// Joins the last element to `next`; sets the start of `next`. `what` names the move in errors.
bool Compensation::join(const CompPlace &place, CompElement &next, bool rapid, std::string_view what,
                        CanonQueue &canon, Fault &fault) {
    const Point corner = next.from;
    const bool is_mm = place.units == LengthUnits::MM;
    const CornerTool tool{side_, radius_, is_mm ? TIP_TOLERANCE_MM : TIP_TOLERANCE_MM / MM_PER_INCH,
                          is_mm ? ROUNDING_MM : ROUNDING_INCH};
    const Corner passed = decide_corner(last_, next, corner, tool);
    switch (passed.kind) {
    case CornerKind::STRAIGHT:
        next.start = last_.end;
        if (next.isArc && distance(next.from, next.to) < TINY) {
            next.end = next.start;  // a full circle that begins beside its end would become a short arc
        }
        return true;
    case CornerKind::AROUND:
        next.start = sum(corner, side_normal(side_, next.start_direction), radius_);
        if (rapid) {
            send_rapid_around(place, next.start, corner, canon);
        } else {
            send_arc(next.start, corner, side_ == CompSide::LEFT ? -1 : 1, place.position, place.plane,
                     canon);
        }
        return true;
    case CornerKind::CUT:
        end_last_at(passed.cut, place.plane, canon);
        next.start = passed.cut;
        return true;
    case CornerKind::BLOCKED: break;
    }
    return fault.set(fmt::format("{} in concave corner cannot be reached by the tool without gouging", what),
                     0, "the moves at the corner are too short or too close together for this tool radius");
}

bool Compensation::move_straight(const CompPlace &place, bool rapid, const Pose &end, CanonQueue &canon,
                                 Fault &fault) {
    const PlaneAxes axes = plane_axes(place.plane);
    const Point from{place.position[axes.first], place.position[axes.second]};
    const Point to{end[axes.first], end[axes.second]};
    const double length = distance(from, to);
    CompElement next;
    if (length > TINY) {
        next.from = from;
        next.to = to;
        next.start_direction = next.end_direction = unit(from, to);
        next.start = sum(from, side_normal(side_, next.start_direction), radius_);
        next.end = sum(to, side_normal(side_, next.start_direction), radius_);
        next.set = true;
        if (!last_.set) {
            next.is_entry = true;
            if (length < radius_ - TINY) {
                return fault.set(
                    "Length of cutter compensation entry move is not greater than the tool radius");
            }
            next.start = sum(from, shift(place.plane), -1.0);
        } else if (!join(place, next, rapid, rapid ? "Straight traverse" : "Straight feed", canon, fault)) {
            return false;
        }
    }
    const Point centre =
        length > TINY ? next.end : (last_.set ? last_.end : sum(to, shift(place.plane), -1.0));
    const Pose tool = in_plane(end, centre, place.plane);
    if (rapid) {
        canon.take(StraightTraverse{tool});
    } else {
        canon.take(StraightFeed{tool});
    }
    if (length > TINY) {
        next.record = canon.size() - 1;
        last_ = next;
    }
    return true;
}

/// The first compensated move as an arc: from the current position, tangent to the offset path at its end.
bool Compensation::enter_by_arc(const CompPlace &place, const ArcPlan &arc, CompElement &next,
                                Fault &fault) const {
    const PlaneAxes axes = plane_axes(place.plane);
    const Point nose = shift(place.plane);
    const Point from{place.position[axes.first] - nose.x, place.position[axes.second] - nose.y};
    const Point normal = side_normal(side_, next.end_direction);
    const Point chord{from.x - next.end.x, from.y - next.end.y};
    const double along = dot(chord, normal);
    // The centre is on the normal at the end, at equal distances from start and end.
    const bool inside = (arc.rotation > 0) == (side_ == CompSide::LEFT);
    const bool is_same_side = (along > TINY) == inside && std::fabs(along) > TINY;
    if (!is_same_side) {
        return fault.set("The entry arc of cutter radius compensation is too small for the tool");
    }
    next.start = from;
    next.centre = sum(next.end, normal, dot(chord, chord) / (2.0 * along));
    next.radius = distance(next.centre, next.end);
    return true;
}

bool Compensation::move_along_arc(const CompPlace &place, const ArcPlan &arc, CanonQueue &canon,
                                  Fault &fault) {
    const PlaneAxes axes = plane_axes(place.plane);
    const Point from{place.position[axes.first], place.position[axes.second]};
    const Point to{arc.end[axes.first], arc.end[axes.second]};
    const double turn = arc.rotation > 0 ? 1.0 : -1.0;
    CompElement next;
    next.isArc = next.set = true;
    next.from = from;
    next.to = to;
    next.rotation = arc.rotation;
    next.centre = {arc.first_centre, arc.second_centre};
    const Point out0 = unit(next.centre, from), out1 = unit(next.centre, to);
    next.start_direction = {-out0.y * turn, out0.x * turn};
    next.end_direction = {-out1.y * turn, out1.x * turn};
    const bool inside = (arc.rotation > 0) == (side_ == CompSide::LEFT);
    const double radius = distance(next.centre, to);
    if (inside && radius <= radius_ + TINY) {
        return fault.set("Tool radius not less than arc radius with comp");
    }
    next.radius = radius + (inside ? -radius_ : radius_);
    next.end = sum(next.centre, out1, next.radius);
    next.start = sum(next.centre, out0, next.radius);
    if (!last_.set) {
        next.is_entry = true;
        if (!enter_by_arc(place, arc, next, fault)) {
            return false;
        }
    } else if (!join(place, next, false, "Arc move", canon, fault)) {
        return false;
    }
    send_arc(next.end, next.centre, arc.rotation, arc.end, place.plane, canon);
    next.record = canon.size() - 1;
    last_ = next;
    return true;
}

}  // namespace mw::gcode::detail

// SPDX-License-Identifier: GPL-2.0-or-later
// Cutter radius compensation: the path moved by the tool's radius to its left or right in the selected plane.
// The end of a move is not final before the next one is known: in a concave corner both offset paths are cut
// at their intersection, around a convex one an arc is inserted.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string_view>

#include <fmt/format.h>

#include "interp/codes/comp/comp_corner.hh"
#include "interp/codes/executor.hh"
#include "interp/codes/plane_geometry.hh"

namespace mw::interp::detail {
namespace {

constexpr double TINY = 1e-10;
/// What a contour that leads back over itself at a tip may lose there.
constexpr double TIP_TOLERANCE_MM = 0.005, MM_PER_INCH = 25.4;
/// What coordinates with four decimals leave open.
constexpr double ROUNDING_MM = 0.0005, ROUNDING_INCH = 0.0001;
/// A rapid move around a corner is made of tangents to the circle about it, each turning by this at most.
constexpr double RAPID_TURN = std::numbers::pi / 3.0;

}  // namespace

/// The unit vector from the path to the tool's side.
Point Executor::comp_normal(Point direction) const {
    return side_normal(state.comp, direction);
}

/// From the centre of a lathe tool's nose to its controlled point, by the tool's orientation 1 to 8.
Point Executor::comp_shift() const {
    static constexpr Point SHIFTS[] = {{0, 0}, {1, -1}, {-1, -1}, {-1, 1}, {1, 1},
                                       {1, 0}, {0, -1}, {-1, 0},  {0, 1},  {0, 0}};  // Z, X
    const bool isLathe = state.comp != CompSide::OFF && state.plane == Plane::XZ;
    const Point shift = SHIFTS[isLathe ? state.comp_orientation : 0];
    return {shift.x * state.comp_radius, shift.y * state.comp_radius};
}

/// The pose at which the tool's centre is at `point`.
Pose Executor::in_plane(Pose pose, Point point) const {
    const PlaneAxes axes = plane_axes();
    const Point shift = comp_shift();
    pose[axes.first] = point.x + shift.x;
    pose[axes.second] = point.y + shift.y;
    return pose;
}

/// An arc of the tool's centre, with the end's other axes as in `end`.
void Executor::send_comp_arc(Point to, Point centre, int rotation, const Pose &end) {
    const PlaneAxes axes = plane_axes();
    const Point shift = comp_shift();
    const Pose place = in_plane(end, to);
    canon.take(ArcFeed{place[axes.first], place[axes.second], centre.x + shift.x, centre.y + shift.y,
                       rotation, place[axes.normal], place});
}

/// G41 and G42 (tool number D), G41.1 and G42.1 (diameter D), G40.
bool Executor::do_comp(const Code &code, const BlockValues &values) {
    if (code.number == 400) {
        end_comp();
        return true;
    }
    if (state.comp != CompSide::OFF) {
        return fault.set("Cannot turn cutter radius compensation on when it is on");
    }
    if (state.plane != Plane::XY && state.plane != Plane::XZ) {
        return fault.set("Cutter radius compensation allowed only in XY, XZ planes");
    }
    const bool isDynamic = code.number % 10 == 1;
    double diameter = state.tool_diameter * machine_to_program();
    state.comp_orientation = state.tool_orientation;
    if (isDynamic) {
        if (values.has('l') && !whole_word(values, 'l', state.comp_orientation)) {
            return false;
        }
        if (values.has('l') && state.plane != Plane::XZ) {
            return fault.set("L, the orientation of a lathe tool, needs the plane G18",
                             values.column_of('l'));
        }
        diameter = values.at('d');
        state.comp_orientation = values.has('l') ? state.comp_orientation : 0;
    } else if (values.has('d')) {
        int toolno = 0, index = 0;
        if (!whole_word(values, 'd', toolno)) {
            return false;
        }
        if (toolno < 0) {
            return fault.set("Negative tool number: D must be 0 or more", values.column_of('d'));
        }
        if (toolno == 0) {
            diameter = 0.0;
        } else if (!find_tool(toolno, values.column_of('d'), index)) {
            return false;
        } else {
            const ToolEntry entry = tool_table_.entry(index);
            diameter = entry.diameter * machine_to_program();
            state.comp_orientation = entry.orientation;
        }
    }
    constexpr int HIGHEST_ORIENTATION = 9;
    if (state.comp_orientation < 0 || state.comp_orientation > HIGHEST_ORIENTATION) {
        return fault.set("The orientation of a lathe tool must be 0 to 9", values.column_of('l'));
    }
    const bool isLeft = (code.number < 420) == (diameter >= 0.0);
    state.comp = isLeft ? CompSide::LEFT : CompSide::RIGHT;
    state.comp_code = code.number;
    state.comp_radius = std::fabs(diameter) / 2.0;
    state.comp_last = {};
    canon.take(ProgramComment{isLeft ? "interpreter: cutter radius compensation on left"
                                     : "interpreter: cutter radius compensation on right"});
    return true;
}

void Executor::end_comp() {
    canon.take(ProgramComment{"interpreter: cutter radius compensation off"});
    state.isCompExit = state.comp != CompSide::OFF && state.comp_last.isSet;
    state.comp = CompSide::OFF;
    state.comp_code = 400;
    state.comp_last = {};
}

/// The last move ends at `end` instead, and so do moves after it that left the plane alone.
void Executor::patch_comp(Point end) {
    for (std::size_t i = state.comp_last.record; i < canon.size(); ++i) {
        CanonCall &call = canon.call(i);
        auto *const feed = std::get_if<StraightFeed>(&call);
        auto *const traverse = std::get_if<StraightTraverse>(&call);
        auto *const arc = std::get_if<ArcFeed>(&call);
        if (feed == nullptr && traverse == nullptr && arc == nullptr) {
            continue;
        }
        patched_.emplace_back(i, call);
        Pose &place = feed != nullptr ? feed->end : traverse != nullptr ? traverse->end : arc->end;
        place = in_plane(place, end);
        if (arc != nullptr) {
            arc->first_end = place[plane_axes().first];
            arc->second_end = place[plane_axes().second];
        }
    }
    state.comp_last.end = end;
}

/// The rapid way around a convex corner, which never comes nearer to it than the tool's radius.
void Executor::send_rapid_around(Point from, Point to, Point corner) {
    const Point a = unit(corner, from), b = unit(corner, to);
    const double direction = state.comp == CompSide::LEFT ? -1.0 : 1.0;
    double turn = std::atan2(cross(a, b), dot(a, b)) * direction;
    turn = turn < -TINY ? turn + 2.0 * std::numbers::pi : turn;
    const int pieces = std::max(1, static_cast<int>(std::ceil(turn / RAPID_TURN)));
    const double half = direction * turn / (2.0 * pieces);
    const double reach = state.comp_radius / std::cos(half);
    for (int i = 0; i < pieces; ++i) {
        const double angle = half * (2 * i + 1), c = std::cos(angle), s = std::sin(angle);
        const Point way{a.x * c - a.y * s, a.x * s + a.y * c};
        canon.take(StraightTraverse{in_plane(state.position, sum(corner, way, reach))});
    }
    canon.take(StraightTraverse{in_plane(state.position, to)});
}

/// Joins the last element to `next`; sets where `next` starts. `what` names the move in errors.
bool Executor::join_comp(CompElement &next, bool isRapid, std::string_view what) {
    const Point corner = next.from;
    const bool isMm = state.units == LengthUnits::MM;
    const CornerTool tool{state.comp, state.comp_radius,
                          isMm ? TIP_TOLERANCE_MM : TIP_TOLERANCE_MM / MM_PER_INCH,
                          isMm ? ROUNDING_MM : ROUNDING_INCH};
    const Corner passed = decide_corner(state.comp_last, next, corner, tool);
    switch (passed.kind) {
    case CornerKind::STRAIGHT:
        next.start = state.comp_last.end;
        if (next.isArc && distance(next.from, next.to) < TINY) {
            next.end = next.start;  // else a whole circle that begins beside its end would be a short arc
        }
        return true;
    case CornerKind::AROUND:
        next.start = sum(corner, comp_normal(next.start_direction), state.comp_radius);
        if (isRapid) {
            send_rapid_around(state.comp_last.end, next.start, corner);
        } else {
            send_comp_arc(next.start, corner, state.comp == CompSide::LEFT ? -1 : 1, state.position);
        }
        return true;
    case CornerKind::CUT:
        patch_comp(passed.cut);
        next.start = passed.cut;
        return true;
    case CornerKind::BLOCKED: break;
    }
    return fault.set(fmt::format("{} in concave corner cannot be reached by the tool without gouging", what),
                     0,
                     "the moves at the corner are too short or too near to each other for this tool radius");
}

bool Executor::comp_straight(bool isRapid, const Pose &end) {
    const PlaneAxes axes = plane_axes();
    const Point from{state.position[axes.first], state.position[axes.second]};
    const Point to{end[axes.first], end[axes.second]};
    const double length = distance(from, to);
    CompElement next;
    if (!isRapid) {
        send_inverse_time(straight_length(end));
    }
    if (length > TINY) {
        next.from = from;
        next.to = to;
        next.start_direction = next.end_direction = unit(from, to);
        next.start = sum(from, comp_normal(next.start_direction), state.comp_radius);
        next.end = sum(to, comp_normal(next.start_direction), state.comp_radius);
        next.isSet = true;
        if (!state.comp_last.isSet) {
            next.isEntry = true;
            if (length < state.comp_radius - TINY) {
                return fault.set(
                    "Length of cutter compensation entry move is not greater than the tool radius");
            }
            next.start = sum(from, comp_shift(), -1.0);
        } else if (!join_comp(next, isRapid, isRapid ? "Straight traverse" : "Straight feed")) {
            return false;
        }
    }
    const Point place = length > TINY
                            ? next.end
                            : (state.comp_last.isSet ? state.comp_last.end : sum(to, comp_shift(), -1.0));
    if (isRapid) {
        canon.take(StraightTraverse{in_plane(end, place)});
    } else {
        canon.take(StraightFeed{in_plane(end, place)});
    }
    if (length > TINY) {
        next.record = canon.size() - 1;
        state.comp_last = next;
    }
    state.position = end;
    return true;
}

/// The first move under compensation as an arc: from where the tool stands, tangent to the offset path at its
/// end.
bool Executor::enter_comp_by_arc(const ArcPlan &arc, CompElement &next) {
    const PlaneAxes axes = plane_axes();
    const Point shift = comp_shift();
    const Point from{state.position[axes.first] - shift.x, state.position[axes.second] - shift.y};
    const Point normal = comp_normal(next.end_direction);
    const Point chord{from.x - next.end.x, from.y - next.end.y};
    const double along = dot(chord, normal);
    // The centre lies on the normal at the end, as far from the start as from the end.
    const bool isInside = (arc.rotation > 0) == (state.comp == CompSide::LEFT);
    const bool isSameSide = (along > TINY) == isInside && std::fabs(along) > TINY;
    if (!isSameSide) {
        return fault.set(
            "This arc cannot be the entry to cutter radius compensation: the tool is too large for it");
    }
    next.start = from;
    next.centre = sum(next.end, normal, dot(chord, chord) / (2.0 * along));
    next.radius = distance(next.centre, next.end);
    return true;
}

bool Executor::comp_arc(const ArcPlan &arc) {
    const PlaneAxes axes = plane_axes();
    const Point from{state.position[axes.first], state.position[axes.second]};
    const Point to{arc.end[axes.first], arc.end[axes.second]};
    const double turn = arc.rotation > 0 ? 1.0 : -1.0;
    CompElement next;
    next.isArc = next.isSet = true;
    next.from = from;
    next.to = to;
    next.rotation = arc.rotation;
    next.centre = {arc.first_centre, arc.second_centre};
    const Point out0 = unit(next.centre, from), out1 = unit(next.centre, to);
    next.start_direction = {-out0.y * turn, out0.x * turn};
    next.end_direction = {-out1.y * turn, out1.x * turn};
    const bool isInside = (arc.rotation > 0) == (state.comp == CompSide::LEFT);
    const double radius = distance(next.centre, to);
    if (isInside && radius <= state.comp_radius + TINY) {
        return fault.set("Tool radius not less than arc radius with comp");
    }
    next.radius = radius + (isInside ? -state.comp_radius : state.comp_radius);
    next.end = sum(next.centre, out1, next.radius);
    next.start = sum(next.centre, out0, next.radius);
    if (state.feed_mode == FeedMode::INVERSE_TIME) {
        send_inverse_time(std::hypot(radius * arc_sweep(arc, from.x, from.y),
                                     arc.end[axes.normal] - state.position[axes.normal]));
    }
    if (!state.comp_last.isSet) {
        next.isEntry = true;
        if (!enter_comp_by_arc(arc, next)) {
            return false;
        }
    } else if (!join_comp(next, false, "Arc move")) {
        return false;
    }
    send_comp_arc(next.end, next.centre, arc.rotation, arc.end);
    next.record = canon.size() - 1;
    state.comp_last = next;
    state.position = arc.end;
    return true;
}

}  // namespace mw::interp::detail

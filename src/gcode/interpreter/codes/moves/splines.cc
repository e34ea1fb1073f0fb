// SPDX-License-Identifier: GPL-2.0-or-later
#include "gcode/interpreter/codes/moves/splines.hh"

#include <fmt/format.h>

#include "gcode/canon/nurbs.hh"
#include "gcode/canon/plane_axes.hh"
#include "gcode/interpreter/codes/block_words.hh"
#include "gcode/interpreter/codes/moves/targets.hh"

namespace mw::gcode::detail {
namespace {

constexpr int MOTION_CUBIC = 50, MOTION_NURBS = 52;
constexpr std::size_t MOST_POINTS = 100'000;

/// Checks common to all splines; `plane_free` when any plane is permitted.
bool check_spline(const BlockValues &values, std::string_view code, bool plane_free, const State &state,
                  Fault &fault) {
    if (!check_feed(values, code, state, fault)) {
        return false;
    }
    if (!plane_free && state.plane != Plane::XY) {
        return fault.set(fmt::format("{} needs the XY plane: G17 first", code));
    }
    if (state.comp.isOn()) {
        return fault.set(fmt::format("{} cannot be used with cutter radius compensation on", code));
    }
    const PlaneAxes axes = plane_axes(state.plane);
    for (int axis = 0; axis < geometry::AXIS_COUNT; ++axis) {
        const char name = geometry::AXIS_LETTERS_LOWER[axis];
        if (axis != axes.first && axis != axes.second && values.has(name)) {
            return fault.set(fmt::format("{} moves only the axes of its plane, not {}", code,
                                         geometry::AXIS_LETTERS_LOWER[axis]),
                             values.column_of(name));
        }
    }
    return true;
}

/// Sends the curve and moves to its end.
bool send_nurbs(NurbsFeed nurbs, State &state, CanonQueue &canon) {
    if (state.feed_mode == FeedMode::INVERSE_TIME) {
        double length = 0;
        for (const PlanePiece &piece : approximate(nurbs, 1e-3)) {
            length += piece.length;
        }
        send_inverse_time(state, canon, length);
    }
    state.position = nurbs.end;
    state.comp.set_exit(false);
    canon.take(std::move(nurbs));
    return true;
}

/// Points after the count are left over from failed blocks.
void keep_control_point(const NurbsPoint &point, std::vector<NurbsPoint> &points, State &state) {
    points.resize(state.spline.count);
    points.push_back(point);
    ++state.spline.count;
}

}  // namespace

bool move_along_cubic(const Code &code, const BlockValues &values, State &state, CanonQueue &canon,
                      Fault &fault) {
    if (!check_spline(values, "G5", false, state, fault)) {
        return false;
    }
    const bool first = state.motion != MOTION_CUBIC;
    if (!values.hasAxes()) {
        return fault.set("G5 needs X or Y, the end of the spline");
    }
    if (values.has('i') != values.has('j')) {
        return fault.set("G5 needs both I and J, or neither to continue in the direction of the previous G5",
                         values.column_of(values.has('i') ? 'i' : 'j'));
    }
    if (first && !values.has('i')) {
        return fault.set(
            "The first G5 of a series needs I and J: the offset from the start to the first control point");
    }
    const Pose end = target(values, state);
    const double x = state.position[geometry::AXIS_X], y = state.position[geometry::AXIS_Y];
    const Point out = values.has('i') ? Point{values.at('i'), values.at('j')} : state.spline.out;
    const double p = values.at('p'), q = values.at('q');
    state.motion = code.number;
    state.cycle.running = false;
    state.spline.out = {-p, -q};
    return send_nurbs({{{x, y, 1},
                        {x + out.x, y + out.y, 1},
                        {end[geometry::AXIS_X] + p, end[geometry::AXIS_Y] + q, 1},
                        {end[geometry::AXIS_X], end[geometry::AXIS_Y], 1}},
                       4,
                       end},
                      state, canon);
}

bool move_along_quadratic(const Code &code, const BlockValues &values, State &state, CanonQueue &canon,
                          Fault &fault) {
    if (!check_spline(values, "G5.1", false, state, fault)) {
        return false;
    }
    if (!values.hasAxes()) {
        return fault.set("G5.1 needs X or Y, the end of the spline");
    }
    const double i = values.has('i') ? values.at('i') : 0.0, j = values.has('j') ? values.at('j') : 0.0;
    if (i == 0.0 && j == 0.0) {
        return fault.set("G5.1 needs I or J other than 0: where its control point lies");
    }
    const Pose end = target(values, state);
    const double x = state.position[geometry::AXIS_X], y = state.position[geometry::AXIS_Y];
    state.motion = code.number;
    state.cycle.running = false;
    return send_nurbs(
        {{{x, y, 1}, {x + i, y + j, 1}, {end[geometry::AXIS_X], end[geometry::AXIS_Y], 1}}, 3, end}, state,
        canon);
}

bool add_nurbs_point(const Code &code, const BlockValues &values, std::vector<NurbsPoint> &points,
                     State &state, CanonQueue &, Fault &fault) {
    if (!check_spline(values, "G5.2", true, state, fault)) {
        return false;
    }
    const PlaneAxes axes = plane_axes(state.plane);
    const double weight = values.has('p') ? values.at('p') : 1.0;
    if (!(weight > 0.0)) {
        return fault.set("The weight P of a control point must be above 0", values.column_of('p'));
    }
    const bool opening = state.spline.order == 0;
    if (values.has('l')) {
        int order = 0;
        if (!whole_word(values, 'l', order, fault)) {
            return false;
        }
        if (!opening || order < 2 || order > MAX_NURBS_ORDER) {
            return fault.set(opening ? fmt::format("The order L of a NURBS is 2 to {}", MAX_NURBS_ORDER)
                                     : "Program the order L once, in the G5.2 that opens the block",
                             values.column_of('l'));
        }
        state.spline.order = order;
    }
    if (opening) {
        constexpr int USUAL_ORDER = 3;
        state.spline.order = values.has('l') ? state.spline.order : USUAL_ORDER;
        state.motion = code.number;
        state.cycle.running = false;
        state.spline.count = 0;
        state.spline.end = state.position;
        const double first_weight = values.hasAxes() ? 1.0 : weight;
        keep_control_point({state.position[axes.first], state.position[axes.second], first_weight}, points,
                           state);
    }
    if (!values.hasAxes()) {
        return opening || fault.set("A control point needs both axes of the plane");
    }
    const char first = geometry::AXIS_LETTERS_LOWER[axes.first],
               second = geometry::AXIS_LETTERS_LOWER[axes.second];
    if (!values.has(first) || !values.has(second)) {
        return fault.set("A control point needs both axes of the plane");
    }
    if (state.spline.count >= MOST_POINTS) {
        return fault.set(fmt::format("A NURBS has at most {} control points", MOST_POINTS));
    }
    state.spline.end = target(values, state);  // incremental points are relative to the start
    keep_control_point({state.spline.end[axes.first], state.spline.end[axes.second], weight}, points, state);
    return true;
}

bool end_nurbs(const Code &, const BlockValues &, std::vector<NurbsPoint> &points, State &state,
               CanonQueue &canon, Fault &fault) {
    if (state.spline.order == 0) {
        return fault.set("G5.3 ends a NURBS, and there is no G5.2 before it");
    }
    if (state.spline.count < static_cast<std::size_t>(state.spline.order)) {
        return fault.set(
            fmt::format("A NURBS of order {} needs at least {} control points, the start among them; "
                        "there are {}",
                        state.spline.order, state.spline.order, state.spline.count));
    }
    points.resize(state.spline.count);
    NurbsFeed nurbs{points, state.spline.order, state.spline.end};
    state.spline.order = 0;
    state.motion = MOTION_NONE;
    return send_nurbs(std::move(nurbs), state, canon);
}

bool check_open_nurbs(const BlockValues &values, const State &state, Fault &fault) {
    if (state.spline.order == 0) {
        return true;
    }
    for (const ActiveCode &active : values.codes) {
        const Code &code = *active.code;
        const bool of_nurbs =
            code.letter == 'g' && (code.number == MOTION_NURBS || code.number == MOTION_NURBS + 1);
        const bool other = code.group == Group::MOTION || code.group == Group::STOP ||
                           code.group == Group::PLANE || code.group == Group::UNITS ||
                           (code.usesAxes && values.hasAxes());
        if (other && !of_nurbs) {
            return fault.set(fmt::format("{} inside of a NURBS: G5.3 ends it", code_name(code)),
                             active.column);
        }
    }
    return true;
}

}  // namespace mw::gcode::detail

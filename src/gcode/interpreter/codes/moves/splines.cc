// SPDX-License-Identifier: GPL-2.0-or-later
#include <fmt/format.h>

#include "gcode/canon/nurbs.hh"
#include "gcode/canon/plane_axes.hh"
#include "gcode/interpreter/codes/block_values.hh"
#include "gcode/interpreter/codes/moves/moves.hh"

namespace mw::gcode::detail {
namespace {

constexpr std::size_t MOST_POINTS = 100'000;

/// Checks common to all splines; `plane_free` if any plane is permitted.
bool check_spline(const BlockValues &values, std::string_view code, bool plane_free, const State &state) {
    if (!check_feed(values, code, state)) {
        return false;
    }
    if (!plane_free && state.plane != Plane::XY) {
        return values.fail(fmt::format("{} needs the XY plane: G17 first", code));
    }
    if (state.comp.isOn()) {
        return values.fail(fmt::format("{} cannot be used with cutter radius compensation on", code));
    }
    const PlaneAxes axes = plane_axes(state.plane);
    for (int axis = 0; axis < geometry::AXIS_COUNT; ++axis) {
        const char name = geometry::AXIS_LETTERS_LOWER[axis];
        if (axis != axes.first && axis != axes.second && values.has(name)) {
            return values.fail(fmt::format("{} moves only the axes of its plane, not {}", code,
                                           geometry::AXIS_LETTERS_LOWER[axis]),
                               name);
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

/// Points after the count remain from failed blocks.
void keep_control_point(const NurbsPoint &point, std::vector<NurbsPoint> &points, State &state) {
    points.resize(state.spline.count);
    points.push_back(point);
    ++state.spline.count;
}

}  // namespace

Effect move_along_cubic(GCode code, const BlockValues &values, State &state, CodeParts &parts) {
    if (!check_spline(values, "G5", false, state)) {
        return false;
    }
    const bool first = state.motion != G(5);
    if (!values.hasAxes()) {
        return values.fail("G5 needs X or Y, the end of the spline");
    }
    if (values.has('i') != values.has('j')) {
        return values.fail(
            "G5 needs both I and J, or neither to continue in the direction of the previous G5",
            values.has('i') ? 'i' : 'j');
    }
    if (first && !values.has('i')) {
        return values.fail(
            "The first G5 of a series needs I and J: the offset from the start to the first control point");
    }
    const Pose end = target(values, state);
    const double x = state.position[geometry::AXIS_X], y = state.position[geometry::AXIS_Y];
    const Point out = values.has('i') ? Point{values.at('i'), values.at('j')} : state.spline.out;
    const double p = values.at('p'), q = values.at('q');
    state.motion = code;
    state.cycle.running = false;
    state.spline.out = {-p, -q};
    return send_nurbs({{{x, y, 1},
                        {x + out.x, y + out.y, 1},
                        {end[geometry::AXIS_X] + p, end[geometry::AXIS_Y] + q, 1},
                        {end[geometry::AXIS_X], end[geometry::AXIS_Y], 1}},
                       4,
                       end},
                      state, parts.canon);
}

Effect move_along_quadratic(GCode code, const BlockValues &values, State &state, CodeParts &parts) {
    if (!check_spline(values, "G5.1", false, state)) {
        return false;
    }
    if (!values.hasAxes()) {
        return values.fail("G5.1 needs X or Y, the end of the spline");
    }
    const double i = values.has('i') ? values.at('i') : 0.0, j = values.has('j') ? values.at('j') : 0.0;
    if (i == 0.0 && j == 0.0) {
        return values.fail("G5.1 needs the control point: I or J other than 0");
    }
    const Pose end = target(values, state);
    const double x = state.position[geometry::AXIS_X], y = state.position[geometry::AXIS_Y];
    state.motion = code;
    state.cycle.running = false;
    return send_nurbs(
        {{{x, y, 1}, {x + i, y + j, 1}, {end[geometry::AXIS_X], end[geometry::AXIS_Y], 1}}, 3, end}, state,
        parts.canon);
}

Effect add_nurbs_point(GCode code, const BlockValues &values, State &state, CodeParts &parts) {
    if (!check_spline(values, "G5.2", true, state)) {
        return false;
    }
    const PlaneAxes axes = plane_axes(state.plane);
    const double weight = values.has('p') ? values.at('p') : 1.0;
    if (!(weight > 0.0)) {
        return values.fail("The weight P of a control point must be above 0", 'p');
    }
    const bool opening = state.spline.order == 0;
    if (values.has('l')) {
        int order = 0;
        if (!values.whole('l', order)) {
            return false;
        }
        if (!opening || order < 2 || order > MAX_NURBS_ORDER) {
            return values.fail(opening ? fmt::format("The order L of a NURBS is 2 to {}", MAX_NURBS_ORDER)
                                       : "Program the order L only once, in the first G5.2 of the NURBS",
                               'l');
        }
        state.spline.order = order;
    }
    if (opening) {
        constexpr int USUAL_ORDER = 3;
        state.spline.order = values.has('l') ? state.spline.order : USUAL_ORDER;
        state.motion = code;
        state.cycle.running = false;
        state.spline.count = 0;
        state.spline.end = state.position;
        const double first_weight = values.hasAxes() ? 1.0 : weight;
        keep_control_point({state.position[axes.first], state.position[axes.second], first_weight},
                           parts.control_points, state);
    }
    if (!values.hasAxes()) {
        return opening || values.fail("A control point needs both axes of the plane");
    }
    const char first = geometry::AXIS_LETTERS_LOWER[axes.first],
               second = geometry::AXIS_LETTERS_LOWER[axes.second];
    if (!values.has(first) || !values.has(second)) {
        return values.fail("A control point needs both axes of the plane");
    }
    if (state.spline.count >= MOST_POINTS) {
        return values.fail(fmt::format("A NURBS has at most {} control points", MOST_POINTS));
    }
    state.spline.end = target(values, state);  // incremental control points are relative to the start
    keep_control_point({state.spline.end[axes.first], state.spline.end[axes.second], weight},
                       parts.control_points, state);
    return true;
}

Effect end_nurbs(GCode, const BlockValues &values, State &state, CodeParts &parts) {
    if (state.spline.order == 0) {
        return values.fail("G5.3 ends a NURBS, and there is no G5.2 before it");
    }
    if (state.spline.count < static_cast<std::size_t>(state.spline.order)) {
        return values.fail(fmt::format(
            "A NURBS of order {} needs at least {} control points, including the start; there are {}",
            state.spline.order, state.spline.order, state.spline.count));
    }
    parts.control_points.resize(state.spline.count);
    NurbsFeed nurbs{parts.control_points, state.spline.order, state.spline.end};
    state.spline.order = 0;
    state.motion = MOTION_NONE;
    return send_nurbs(std::move(nurbs), state, parts.canon);
}

bool check_open_nurbs(const BlockValues &values, const State &state) {
    if (state.spline.order == 0) {
        return true;
    }
    for (const ActiveCode &active : values.codes) {
        const Code &code = *active.code;
        const bool of_nurbs = code.id == G(5, 2) || code.id == G(5, 3);
        const bool other = code.group == Group::MOTION || code.group == Group::STOP ||
                           code.group == Group::PLANE || code.group == Group::UNITS ||
                           (code.usesAxes && values.hasAxes());
        if (other && !of_nurbs) {
            return values.fault->set(
                fmt::format("{} inside a NURBS: end the NURBS with G5.3 first", code_name(code.id)),
                active.column);
        }
    }
    return true;
}

}  // namespace mw::gcode::detail

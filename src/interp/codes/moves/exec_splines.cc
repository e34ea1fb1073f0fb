// SPDX-License-Identifier: GPL-2.0-or-later
// Splines in the selected plane: G5 (cubic), G5.1 (quadratic), G5.2 and G5.3 (NURBS).
#include <fmt/format.h>

#include "interp/canon/nurbs.hh"
#include "interp/codes/executor.hh"

namespace mw::interp::detail {
namespace {

constexpr int MOTION_CUBIC = 50, MOTION_NURBS = 52;
constexpr std::size_t MOST_POINTS = 100'000;

}  // namespace

/// What all splines ask for; `isPlaneFree` when they may lie in any plane.
bool Executor::check_spline(const BlockValues &values, std::string_view code, bool isPlaneFree) {
    if (!check_feed(values, code)) {
        return false;
    }
    if (!isPlaneFree && state.plane != Plane::XY) {
        return fault.set(fmt::format("{} needs the XY plane: G17 first", code));
    }
    if (state.comp != CompSide::OFF) {
        return fault.set(fmt::format("{} cannot be used with cutter radius compensation on", code));
    }
    if (values.isMachineCoordinates) {
        return fault.set(fmt::format("Cannot use g53 with {}", code));
    }
    const PlaneAxes axes = plane_axes();
    for (int axis = 0; axis < geom::AXIS_COUNT; ++axis) {
        const char name = geom::AXIS_LETTERS_LOWER[axis];
        if (axis != axes.first && axis != axes.second && values.has(name)) {
            return fault.set(fmt::format("{} moves only the axes of its plane, not {}", code,
                                         geom::AXIS_LETTERS_LOWER[axis]),
                             values.column_of(name));
        }
    }
    return true;
}

/// Sends the curve and moves to its end.
bool Executor::send_nurbs(NurbsFeed nurbs) {
    if (state.feed_mode == FeedMode::INVERSE_TIME) {
        double length = 0;
        for (const PlanePiece &piece : approximate(nurbs, 1e-3)) {
            length += piece.length;
        }
        send_inverse_time(length);
    }
    state.position = nurbs.end;
    state.isCompExit = false;
    canon.take(std::move(nurbs));
    return true;
}

bool Executor::do_cubic_spline(const Code &code, const BlockValues &values) {
    if (!check_spline(values, "G5", false)) {
        return false;
    }
    const bool isFirst = state.motion != MOTION_CUBIC;
    if (!values.hasAxes()) {
        return fault.set("G5 needs X or Y, the end of the spline");
    }
    if (values.has('i') != values.has('j')) {
        return fault.set("G5 needs both I and J, or neither to go on in the direction of the G5 before",
                         values.column_of(values.has('i') ? 'i' : 'j'));
    }
    if (isFirst && !values.has('i')) {
        return fault.set("The first G5 of a series needs I and J: where it leaves its start to");
    }
    const Pose end = target(values);
    const double x = state.position[geom::AXIS_X], y = state.position[geom::AXIS_Y];
    const Point out = values.has('i') ? Point{values.at('i'), values.at('j')} : state.spline_out;
    const double p = values.at('p'), q = values.at('q');
    state.motion = code.number;
    state.cycle.isRunning = false;
    state.spline_out = {-p, -q};
    return send_nurbs({{{x, y, 1},
                        {x + out.x, y + out.y, 1},
                        {end[geom::AXIS_X] + p, end[geom::AXIS_Y] + q, 1},
                        {end[geom::AXIS_X], end[geom::AXIS_Y], 1}},
                       4,
                       end});
}

bool Executor::do_quadratic_spline(const Code &code, const BlockValues &values) {
    if (!check_spline(values, "G5.1", false)) {
        return false;
    }
    if (!values.hasAxes()) {
        return fault.set("G5.1 needs X or Y, the end of the spline");
    }
    const double i = values.has('i') ? values.at('i') : 0.0, j = values.has('j') ? values.at('j') : 0.0;
    if (i == 0.0 && j == 0.0) {
        return fault.set("G5.1 needs I or J other than 0: where its control point lies");
    }
    const Pose end = target(values);
    const double x = state.position[geom::AXIS_X], y = state.position[geom::AXIS_Y];
    state.motion = code.number;
    state.cycle.isRunning = false;
    return send_nurbs({{{x, y, 1}, {x + i, y + j, 1}, {end[geom::AXIS_X], end[geom::AXIS_Y], 1}}, 3, end});
}

/// G5.2 itself and the lines after it: a control point each.
bool Executor::do_nurbs_point(const Code &code, const BlockValues &values) {
    if (!check_spline(values, "G5.2", true)) {
        return false;
    }
    const PlaneAxes axes = plane_axes();
    const double weight = values.has('p') ? values.at('p') : 1.0;
    if (!(weight > 0.0)) {
        return fault.set("The weight P of a control point must be above 0", values.column_of('p'));
    }
    const bool isOpening = state.nurbs_order == 0;
    if (values.has('l')) {
        int order = 0;
        if (!whole_word(values, 'l', order)) {
            return false;
        }
        if (!isOpening || order < 2 || order > MAX_NURBS_ORDER) {
            return fault.set(isOpening ? fmt::format("The order L of a NURBS is 2 to {}", MAX_NURBS_ORDER)
                                       : "The order L is said once, with the G5.2 that opens the block",
                             values.column_of('l'));
        }
        state.nurbs_order = order;
    }
    if (isOpening) {
        constexpr int USUAL_ORDER = 3;
        state.nurbs_order = values.has('l') ? state.nurbs_order : USUAL_ORDER;
        state.motion = code.number;
        state.cycle.isRunning = false;
        state.nurbs_count = 0;
        state.nurbs_end = state.position;
        const double first_weight = values.hasAxes() ? 1.0 : weight;
        keep_control_point({state.position[axes.first], state.position[axes.second], first_weight});
    }
    if (!values.hasAxes()) {
        return isOpening || fault.set("A control point needs both axes of the plane");
    }
    const char first = geom::AXIS_LETTERS_LOWER[axes.first], second = geom::AXIS_LETTERS_LOWER[axes.second];
    if (!values.has(first) || !values.has(second)) {
        return fault.set("A control point needs both axes of the plane");
    }
    if (state.nurbs_count >= MOST_POINTS) {
        return fault.set(fmt::format("A NURBS has at most {} control points", MOST_POINTS));
    }
    state.nurbs_end = target(values);  // incremental points count from the start
    keep_control_point({state.nurbs_end[axes.first], state.nurbs_end[axes.second], weight});
    return true;
}

/// Points behind nurbs_count are left over from blocks that failed.
void Executor::keep_control_point(const NurbsPoint &point) {
    control_points_.resize(state.nurbs_count);
    control_points_.push_back(point);
    ++state.nurbs_count;
}

bool Executor::do_nurbs_end(const Code &, const BlockValues &) {
    if (state.nurbs_order == 0) {
        return fault.set("G5.3 ends a NURBS, and there is no G5.2 before it");
    }
    if (state.nurbs_count < static_cast<std::size_t>(state.nurbs_order)) {
        return fault.set(
            fmt::format("A NURBS of order {} needs at least {} control points, the start among them; "
                        "there are {}",
                        state.nurbs_order, state.nurbs_order, state.nurbs_count));
    }
    control_points_.resize(state.nurbs_count);
    NurbsFeed nurbs{control_points_, state.nurbs_order, state.nurbs_end};
    state.nurbs_order = 0;
    state.motion = MOTION_NONE;
    return send_nurbs(std::move(nurbs));
}

/// Between G5.2 and G5.3 there are control points and nothing else that moves or ends.
bool Executor::check_open_nurbs(const BlockValues &values) {
    if (state.nurbs_order == 0) {
        return true;
    }
    for (const ActiveCode &active : values.codes) {
        const Code &code = *active.code;
        const bool isOfNurbs =
            code.letter == 'g' && (code.number == MOTION_NURBS || code.number == MOTION_NURBS + 1);
        const bool isOther = code.group == Group::MOTION || code.group == Group::STOP ||
                             code.group == Group::PLANE || code.group == Group::UNITS ||
                             (code.usesAxes && values.hasAxes());
        if (isOther && !isOfNurbs) {
            return fault.set(fmt::format("{} inside of a NURBS: G5.3 ends it", code_name(code)),
                             active.column);
        }
    }
    return true;
}

}  // namespace mw::interp::detail

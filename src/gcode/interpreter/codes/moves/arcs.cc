// SPDX-License-Identifier: GPL-2.0-or-later
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "gcode/interpreter/codes/block_values.hh"
#include "gcode/interpreter/codes/moves/moves.hh"

namespace mw::gcode::detail {
namespace {

/// Permitted difference of the radii at the start and end of an arc: coordinates rounded to 0.01 mm or 0.001
/// inch at both ends, in both axes. For large arcs, for which this is below RELATIVE_TOLERANCE, up to a
/// hundred times as much.
constexpr double TOLERANCE_MM = 0.02 * std::numbers::sqrt2, TOLERANCE_INCH = 0.002 * std::numbers::sqrt2;
constexpr double LARGE_FACTOR = 100.0;
constexpr double RELATIVE_TOLERANCE = 0.001;

constexpr char centre_letter(int axis) {
    switch (axis) {
    case geometry::AXIS_X:
    case geometry::AXIS_U: return 'i';
    case geometry::AXIS_Y:
    case geometry::AXIS_V: return 'j';
    default: return 'k';
    }
}

std::string plane_name(const PlaneAxes &axes) {
    std::string name{geometry::AXIS_LETTERS_LOWER[axes.first], geometry::AXIS_LETTERS_LOWER[axes.second]};
    return name == "zx" ? "xz" : name;
}

bool plan_centre_arc(const BlockValues &values, const State &state, ArcPlan &arc) {
    const PlaneAxes axes = plane_axes(state.plane);
    const char first = centre_letter(axes.first), second = centre_letter(axes.second);
    const double x0 = state.position[axes.first], y0 = state.position[axes.second];
    if (state.centre_absolute) {
        for (const char c : {first, second}) {
            if (!values.has(c)) {
                return values.fail(
                    fmt::format("{} word missing in absolute center arc", static_cast<char>(c - 'a' + 'A')));
            }
        }
        arc.first_centre = values.at(first);
        arc.second_centre = values.at(second);
    } else {
        arc.first_centre = x0 + values.at(first, 0.0);
        arc.second_centre = y0 + values.at(second, 0.0);
    }
    const double x1 = arc.end[axes.first], y1 = arc.end[axes.second];
    const double r1 = std::hypot(x0 - arc.first_centre, y0 - arc.second_centre);
    const double r2 = std::hypot(x1 - arc.first_centre, y1 - arc.second_centre);
    const double tolerance = state.units == LengthUnits::MM ? TOLERANCE_MM : TOLERANCE_INCH;
    constexpr double LEAST_RADIUS = 1e-12;
    if (r1 < LEAST_RADIUS || r2 < LEAST_RADIUS) {
        return values.fail("Zero-radius arc: start or end lies in the center", first);
    }
    const double error = std::fabs(r1 - r2), relative = error / std::fmax(r1, r2);
    if (error > tolerance * LARGE_FACTOR || (error > tolerance && relative > RELATIVE_TOLERANCE)) {
        const char a = geometry::AXIS_LETTERS[axes.first], b = geometry::AXIS_LETTERS[axes.second];
        return values.fail(
            fmt::format("Radius to end of arc differs from radius to start: "
                        "start=({}{:.4f},{}{:.4f}) center=({}{:.4f},{}{:.4f}) end=({}{:.4f},{}{:.4f}) "
                        "r1={:.4f} r2={:.4f} abs_err={:.4g} rel_err={:.4f}%",
                        a, x0, b, y0, a, arc.first_centre, b, arc.second_centre, a, x1, b, y1, r1, r2, error,
                        relative * 100.0));
    }
    return true;
}

/// R > 0: the arc of at most 180 degrees; R < 0: the arc of more than 180 degrees.
bool plan_radius_arc(const BlockValues &values, const Settings &settings, const State &state, ArcPlan &arc) {
    const PlaneAxes axes = plane_axes(state.plane);
    const double x0 = state.position[axes.first], y0 = state.position[axes.second];
    const double dx = arc.end[axes.first] - x0, dy = arc.end[axes.second] - y0;
    const double half = std::hypot(dx, dy) / 2.0;
    if (half == 0.0) {
        return values.fail("Current point same as end point of arc");
    }
    const double tolerance = state.units == LengthUnits::MM ? settings.center_arc_tolerance.mm
                                                            : settings.center_arc_tolerance.inch;
    const double radius = values.at('r'), size = std::fabs(radius);
    if (half - size > tolerance) {
        return values.fail("Arc radius too small to reach end point");
    }
    const double rise = size > half ? std::sqrt(size * size - half * half) : 0.0;
    const bool left = (arc.rotation > 0) == (radius > 0.0);  // of the chord
    const double side = (left ? rise : -rise) / (2.0 * half);
    arc.first_centre = x0 + dx / 2.0 - dy * side;
    arc.second_centre = y0 + dy / 2.0 + dx * side;
    return true;
}

double arc_sweep(const ArcPlan &arc, const PlaneAxes &axes, double x0, double y0) {
    const double ax = x0 - arc.first_centre, ay = y0 - arc.second_centre;
    const double bx = arc.end[axes.first] - arc.first_centre, by = arc.end[axes.second] - arc.second_centre;
    constexpr double FULL_TURN = 2.0 * std::numbers::pi, SAME_ANGLE = 1e-10;
    double angle = std::atan2(ax * by - ay * bx, ax * bx + ay * by);
    if (arc.rotation > 0) {
        angle += (angle < SAME_ANGLE ? FULL_TURN : 0.0) + FULL_TURN * (arc.rotation - 1);
    } else {
        angle -= (angle > -SAME_ANGLE ? FULL_TURN : 0.0) + FULL_TURN * (-arc.rotation - 1);
    }
    return angle;
}

void send_arc(const ArcPlan &arc, State &state, CanonQueue &canon) {
    const PlaneAxes axes = plane_axes(state.plane);
    if (state.feed_mode == FeedMode::INVERSE_TIME) {
        const double x0 = state.position[axes.first], y0 = state.position[axes.second];
        const double radius = std::hypot(x0 - arc.first_centre, y0 - arc.second_centre);
        send_inverse_time(state, canon,
                          std::hypot(radius * arc_sweep(arc, plane_axes(state.plane), x0, y0),
                                     arc.end[axes.normal] - state.position[axes.normal]));
    }
    canon.take(ArcFeed{arc.end[axes.first], arc.end[axes.second], arc.first_centre, arc.second_centre,
                       arc.rotation, arc.end[axes.normal], arc.end});
    state.position = arc.end;
}

}  // namespace

Effect move_along_arc(GCode code, const BlockValues &values, State &state, CodeParts &parts) {
    if (state.feed == 0.0 || (state.feed_mode == FeedMode::INVERSE_TIME && !values.has('f'))) {
        return state.feed == 0.0 ? values.fail("Cannot make arc with zero feed rate")
                                 : values.fail("F word missing with inverse time arc move");
    }
    if (!check_feed_per_revolution(values, state)) {
        return false;
    }
    if (state.comp.isExit()) {
        return values.fail(
            "The move just after exiting cutter compensation mode must be straight, not an arc");
    }
    ArcPlan arc;
    if (!plan_arc(code == G(3), values, parts.settings, state, arc)) {
        return false;
    }
    state.motion = code;
    state.cycle.running = false;
    if (state.comp.isOn()) {
        const PlaneAxes axes = plane_axes(state.plane);
        if (state.feed_mode == FeedMode::INVERSE_TIME) {
            const Point from{state.position[axes.first], state.position[axes.second]};
            const Point to{arc.end[axes.first], arc.end[axes.second]};
            const double radius = distance({arc.first_centre, arc.second_centre}, to);
            send_inverse_time(state, parts.canon,
                              std::hypot(radius * arc_sweep(arc, axes, from.x, from.y),
                                         arc.end[axes.normal] - state.position[axes.normal]));
        }
        const CompPlace place{state.position, state.plane, state.units};
        if (!state.comp.move_along_arc(place, arc, parts.canon, *values.fault)) {
            return false;
        }
        state.position = arc.end;
        return true;
    }
    send_arc(arc, state, parts.canon);
    return true;
}

/// The programmed arc from the current position.
bool plan_arc(bool counterclockwise, const BlockValues &values, const Settings &settings, const State &state,
              ArcPlan &arc) {
    const PlaneAxes axes = plane_axes(state.plane);
    const char first = centre_letter(axes.first), second = centre_letter(axes.second);
    const bool has_centre = values.has(first) || values.has(second);
    arc.end = target(values, state);
    if (!polar_target(values, state, arc.end)) {
        return false;
    }
    int turns = 1;
    if (values.has('p')) {
        if (!values.whole('p', turns)) {
            return false;
        }
        if (turns < 1 || turns > 1000000) {
            return values.fail("P value should be 1 or greater with G2 or G3", 'p');
        }
    }
    arc.rotation = counterclockwise ? turns : -turns;
    for (const char c : {'i', 'j', 'k'}) {
        if (values.has(c) && c != first && c != second) {
            return values.fail(fmt::format("{} word given for arc in {} plane",
                                           static_cast<char>(c - 'a' + 'A'), plane_name(axes)),
                               c);
        }
    }
    if (values.has('r')) {
        if (has_centre) {
            return values.fail("Mixed radius ijk format for arc", 'r');
        }
        return plan_radius_arc(values, settings, state, arc);
    }
    if (!has_centre) {
        return values.fail("R i j k words all missing for arc");
    }
    return plan_centre_arc(values, state, arc);
}

}  // namespace mw::gcode::detail

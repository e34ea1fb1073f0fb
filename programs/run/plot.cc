// SPDX-License-Identifier: GPL-2.0-or-later
#include "programs/run/plot.hh"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/charts/canvas.hh"
#include "base/charts/chart.hh"

namespace mw::programs {
namespace {

using gcode::PathPoint;

constexpr double WIDTH = 1400, HEIGHT = 760, MARGIN = 60, TOP = 70;

/// To the right and upwards, in machine units.
struct Flat {
    double x, y;
};
using Projection = Flat (*)(const PathPoint &);

Flat from_above(const PathPoint &p) {
    return {p.x, p.y};
}

/// A view from the front right, 35 degrees above.
Flat from_an_angle(const PathPoint &p) {
    constexpr double C = 0.8660254037844387, S = 0.5;
    constexpr double TILT = 0.574, RISE = 0.819;
    return {C * p.x - S * p.y, TILT * (S * p.x + C * p.y) + RISE * p.z};
}

Flat as_turned(const PathPoint &p) {
    return {p.z, p.x};
}

struct Window {
    double left, top, width, height;
};

/// Machine units to pixels, with the same factor in both directions.
struct Scale {
    double factor, dx, dy;
    Flat low, high;  ///< visible range

    double px(double x) const { return x * factor + dx; }
    double py(double y) const { return dy - y * factor; }
    Flat operator()(const Flat &p) const { return {px(p.x), py(p.y)}; }
};

Scale fit(const std::vector<PathPoint> &points, Projection project, const Window &window) {
    Flat low{1e300, 1e300}, high{-1e300, -1e300};
    for (const PathPoint &point : points) {
        const Flat p = project(point);
        low = {std::min(low.x, p.x), std::min(low.y, p.y)};
        high = {std::max(high.x, p.x), std::max(high.y, p.y)};
    }
    if (points.empty()) {
        low = high = {0, 0};
    }
    const double width = std::max(high.x - low.x, 1e-6), height = std::max(high.y - low.y, 1e-6);
    const double factor = std::min(window.width / width, window.height / height);
    const double dx = window.left + (window.width - width * factor) / 2 - low.x * factor;
    const double dy = window.top + (window.height + height * factor) / 2 + low.y * factor;
    const Flat corner{(window.left - dx) / factor, (dy - window.top - window.height) / factor};
    return {factor, dx, dy, corner, {corner.x + window.width / factor, corner.y + window.height / factor}};
}

void draw_moves(const charts::Canvas &canvas, const std::vector<PathPoint> &points, Projection project,
                const Scale &scale, bool rapid) {
    cairo_t *cr = canvas.cairo();
    if (rapid) {
        canvas.set_color(0.85, 0.35, 0.2, 0.5);
    } else {
        canvas.set_color(0.1, 0.3, 0.65, 0.9);
    }
    cairo_set_line_width(cr, rapid ? 0.6 : 0.9);
    Flat last{-1e9, -1e9};
    bool down = false;
    for (std::size_t i = 1; i < points.size(); ++i) {
        if (points[i].isRapid != rapid) {
            down = false;
            continue;
        }
        const Flat from = scale(project(points[i - 1])), to = scale(project(points[i]));
        // Points at a distance below a third of a pixel are omitted.
        if (down && std::hypot(to.x - last.x, to.y - last.y) < 0.35) {
            continue;
        }
        if (!down) {
            cairo_move_to(cr, from.x, from.y);
        }
        cairo_line_to(cr, to.x, to.y);
        last = to;
        down = true;
    }
    cairo_stroke(cr);
}

/// Grid and labels of both axes.
void draw_axes(const charts::Canvas &canvas, const Scale &scale, const Window &window,
               const std::string &across, const std::string &upwards) {
    constexpr double SMALL = 11;
    const double bottom = window.top + window.height;
    for (const double x : charts::round_ticks(scale.low.x, scale.high.x, 8)) {
        canvas.set_color(0.9, 0.9, 0.9);
        canvas.line(scale.px(x), window.top, scale.px(x), bottom, 0.7);
        canvas.set_color(0.3, 0.3, 0.3);
        const std::string figure = fmt::format("{:g}", x);
        canvas.text(scale.px(x) - canvas.text_width(figure, SMALL) / 2, bottom + 16, figure, SMALL);
    }
    for (const double y : charts::round_ticks(scale.low.y, scale.high.y, 8)) {
        canvas.set_color(0.9, 0.9, 0.9);
        canvas.line(window.left, scale.py(y), window.left + window.width, scale.py(y), 0.7);
        canvas.set_color(0.3, 0.3, 0.3);
        const std::string figure = fmt::format("{:g}", y);
        canvas.text(window.left - 6 - canvas.text_width(figure, SMALL), scale.py(y) + 4, figure, SMALL);
    }
    canvas.set_color(0.2, 0.2, 0.2);
    canvas.text(window.left + window.width / 2, bottom + 34, across, 13);
    canvas.text(window.left, window.top - 8, upwards, 13);
}

/// Vertical feed moves, as points seen from above.
std::vector<Flat> holes(const std::vector<PathPoint> &points) {
    std::vector<Flat> found;
    for (std::size_t i = 1; i < points.size(); ++i) {
        const PathPoint &from = points[i - 1], &to = points[i];
        constexpr float STRAIGHT = 1e-4F;
        const bool down = !to.isRapid && to.z < from.z && std::fabs(to.x - from.x) < STRAIGHT &&
                          std::fabs(to.y - from.y) < STRAIGHT;
        const bool is_new = found.empty() || std::fabs(found.back().x - to.x) > STRAIGHT ||
                            std::fabs(found.back().y - to.y) > STRAIGHT;
        if (down && is_new) {
            found.push_back({to.x, to.y});
        }
    }
    return found;
}

void draw_holes(const charts::Canvas &canvas, const std::vector<PathPoint> &points, const Scale &scale) {
    constexpr double RADIUS = 4, FULL_TURN = 6.283185307179586;
    cairo_t *cr = canvas.cairo();
    canvas.set_color(0.1, 0.3, 0.65, 0.9);
    cairo_set_line_width(cr, 1.2);
    for (const Flat &hole : holes(points)) {
        const Flat at = scale(hole);
        cairo_new_sub_path(cr);
        cairo_arc(cr, at.x, at.y, RADIUS, 0, FULL_TURN);
        cairo_stroke(cr);
    }
}

void draw_centre_line(const charts::Canvas &canvas, const Scale &scale, const Window &window) {
    if (scale.low.y > 0 || scale.high.y < 0) {
        return;
    }
    constexpr double DASHES[] = {14, 4, 2, 4};
    cairo_set_dash(canvas.cairo(), DASHES, 4, 0);
    canvas.set_color(0.2, 0.2, 0.2);
    canvas.line(window.left, scale.py(0), window.left + window.width, scale.py(0), 1.0);
    cairo_set_dash(canvas.cairo(), nullptr, 0, 0);
}

void draw_legend(const charts::Canvas &canvas, const std::string &title, bool has_holes) {
    canvas.set_color(0.1, 0.1, 0.1);
    canvas.text(MARGIN, 34, title, 18);
    canvas.set_color(0.1, 0.3, 0.65);
    canvas.text(WIDTH - 260, 34, has_holes ? "feed, o plunge" : "feed", 13);
    canvas.set_color(0.85, 0.35, 0.2);
    canvas.text(WIDTH - 140, 34, "rapid", 13);
}

void draw_mill(const charts::Canvas &canvas, const std::vector<PathPoint> &points, const std::string &unit) {
    const double width = (WIDTH - 3 * MARGIN) / 2, height = HEIGHT - TOP - MARGIN;
    const Window above{MARGIN, TOP, width, height}, angle{2 * MARGIN + width, TOP, width, height};
    const Scale flat = fit(points, from_above, above);
    draw_axes(canvas, flat, above, "X [" + unit + "]", "Y [" + unit + "]");
    for (const bool rapid : {true, false}) {
        draw_moves(canvas, points, from_above, flat, rapid);
        draw_moves(canvas, points, from_an_angle, fit(points, from_an_angle, angle), rapid);
    }
    draw_holes(canvas, points, flat);
}

void draw_lathe(const charts::Canvas &canvas, const std::vector<PathPoint> &points, const std::string &unit) {
    const Window window{MARGIN, TOP, WIDTH - 2 * MARGIN, HEIGHT - TOP - MARGIN};
    const Scale scale = fit(points, as_turned, window);
    draw_axes(canvas, scale, window, "Z [" + unit + "]", "X, radius [" + unit + "]");
    draw_centre_line(canvas, scale, window);
    for (const bool rapid : {true, false}) {
        draw_moves(canvas, points, as_turned, scale, rapid);
    }
}

}  // namespace

Result<> plot_path(const std::vector<PathPoint> &points, const machine::MachineConfig &machine,
                   const std::string &program, const std::string &path) {
    auto canvas = charts::Canvas::open(path, WIDTH, HEIGHT);
    if (!canvas) {
        return std::unexpected(canvas.error());
    }
    constexpr unsigned XZ = 0b101, XYZ = 0b111;
    const bool is_lathe = machine.task.interpreter.is_lathe || (machine.axis_mask & XYZ) == XZ;
    const std::string unit = machine.metric ? "mm" : "inch";
    draw_legend(*canvas, program + " on " + machine.name + ", machine coordinates", !is_lathe);
    if (is_lathe) {
        draw_lathe(*canvas, points, unit);
    } else {
        draw_mill(*canvas, points, unit);
    }
    return canvas->write();
}

Result<> check_picture(const std::string &path) {
    return charts::Canvas::check(path);
}

}  // namespace mw::programs

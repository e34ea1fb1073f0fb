// SPDX-License-Identifier: GPL-2.0-or-later
#include "machine/plot.hh"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "picture/canvas.hh"

namespace mw::machine {
namespace {

constexpr double WIDTH = 1400, HEIGHT = 760, MARGIN = 50, TOP = 60;

struct Flat {
    double x, y;
};
using Projection = Flat (*)(const PathPoint &);

Flat from_above(const PathPoint &p) {
    return {p.x, -p.y};
}

/// A view from the front right, 35 degrees above.
Flat from_an_angle(const PathPoint &p) {
    constexpr double C = 0.8660254037844387, S = 0.5;
    constexpr double TILT = 0.574, RISE = 0.819;
    return {C * p.x - S * p.y, -(TILT * (S * p.x + C * p.y) + RISE * p.z)};
}

struct Window {
    double left, top, width, height;
};

struct Scale {
    double factor, dx, dy;
    Flat operator()(const Flat &p) const { return {p.x * factor + dx, p.y * factor + dy}; }
};

Scale fit(const std::vector<PathPoint> &points, Projection project, const Window &window) {
    Flat low{1e300, 1e300}, high{-1e300, -1e300};
    for (const PathPoint &point : points) {
        const Flat p = project(point);
        low = {std::min(low.x, p.x), std::min(low.y, p.y)};
        high = {std::max(high.x, p.x), std::max(high.y, p.y)};
    }
    const double width = std::max(high.x - low.x, 1e-6), height = std::max(high.y - low.y, 1e-6);
    const double factor = std::min(window.width / width, window.height / height);
    return {factor, window.left + (window.width - width * factor) / 2 - low.x * factor,
            window.top + (window.height - height * factor) / 2 - low.y * factor};
}

void draw_moves(cairo_t *cr, const std::vector<PathPoint> &points, Projection project, const Scale &scale,
                bool isRapid) {
    if (isRapid) {
        cairo_set_source_rgba(cr, 0.85, 0.35, 0.2, 0.5);
    } else {
        cairo_set_source_rgba(cr, 0.1, 0.3, 0.65, 0.9);
    }
    cairo_set_line_width(cr, isRapid ? 0.6 : 0.9);
    Flat last{-1e9, -1e9};
    bool isDown = false;
    for (std::size_t i = 1; i < points.size(); ++i) {
        if (points[i].isRapid != isRapid) {
            isDown = false;
            continue;
        }
        const Flat from = scale(project(points[i - 1])), to = scale(project(points[i]));
        // Points nearer than a third of a pixel add nothing to the picture.
        if (isDown && std::hypot(to.x - last.x, to.y - last.y) < 0.35) {
            continue;
        }
        if (!isDown) {
            cairo_move_to(cr, from.x, from.y);
        }
        cairo_line_to(cr, to.x, to.y);
        last = to;
        isDown = true;
    }
    cairo_stroke(cr);
}

void draw_scale_bar(cairo_t *cr, const Scale &scale, const Window &window, const std::string &unit) {
    double length = std::pow(10.0, std::floor(std::log10(window.width / scale.factor / 3.0)));
    length *= window.width / scale.factor / length > 12 ? 2 : 1;
    const double y = window.top + window.height + 24;
    cairo_set_source_rgb(cr, 0.2, 0.2, 0.2);
    cairo_set_line_width(cr, 1.5);
    cairo_move_to(cr, window.left, y);
    cairo_line_to(cr, window.left + length * scale.factor, y);
    cairo_stroke(cr);
    cairo_move_to(cr, window.left + length * scale.factor + 8, y + 4);
    cairo_show_text(cr, fmt::format("{:g} {}", length, unit).c_str());
}

void draw(cairo_t *cr, const std::vector<PathPoint> &points, const std::string &title,
          const std::string &unit) {
    cairo_set_font_size(cr, 18);
    cairo_set_source_rgb(cr, 0.1, 0.1, 0.1);
    cairo_move_to(cr, MARGIN, 34);
    cairo_show_text(cr, title.c_str());
    cairo_set_font_size(cr, 13);
    const double width = (WIDTH - 3 * MARGIN) / 2, height = HEIGHT - TOP - 2 * MARGIN;
    const std::array<Projection, 2> views{from_above, from_an_angle};
    for (std::size_t i = 0; i < views.size(); ++i) {
        const Window window{MARGIN + static_cast<double>(i) * (width + MARGIN), TOP, width, height};
        const Scale scale = fit(points, views[i], window);
        draw_moves(cr, points, views[i], scale, true);
        draw_moves(cr, points, views[i], scale, false);
        if (i == 0) {
            draw_scale_bar(cr, scale, window, unit);
        }
    }
    cairo_set_source_rgb(cr, 0.1, 0.3, 0.65);
    cairo_move_to(cr, WIDTH - 260, 34);
    cairo_show_text(cr, "feed");
    cairo_set_source_rgb(cr, 0.85, 0.35, 0.2);
    cairo_move_to(cr, WIDTH - 200, 34);
    cairo_show_text(cr, "rapid");
}

}  // namespace

Result<> plot_path(const std::vector<PathPoint> &points, const std::string &title, const std::string &unit,
                   const std::string &path) {
    auto canvas = picture::Canvas::open(path, WIDTH, HEIGHT);
    if (!canvas) {
        return std::unexpected(canvas.error());
    }
    draw(canvas->cairo(), points, title, unit);
    return canvas->write();
}

}  // namespace mw::machine

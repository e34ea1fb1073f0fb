// SPDX-License-Identifier: GPL-2.0-or-later
#include "base/charts/canvas.hh"

#include <unistd.h>

#include <cairo-svg.h>
#include <cerrno>
#include <cstring>
#include <filesystem>

namespace mw::charts {
namespace {

bool isPng(const std::string &path) {
    return path.size() > 4 && path.ends_with(".png");
}

}  // namespace

Result<> Canvas::check(const std::string &path) {
    namespace fs = std::filesystem;
    if (!isPng(path) && !(path.size() > 4 && path.ends_with(".svg"))) {
        return fail("a picture is a .png or .svg file, not '" + path + "'");
    }
    const fs::path folder = fs::path(path).parent_path();
    const std::string place = fs::exists(path) ? path : folder.empty() ? "." : folder.string();
    if (::access(place.c_str(), W_OK) != 0) {
        return fail("cannot write the picture '" + path + "': " + std::strerror(errno));
    }
    return {};
}

Result<Canvas> Canvas::open(const std::string &path, double width, double height) {
    if (const auto drawable = check(path); !drawable.has_value()) {
        return std::unexpected(drawable.error());
    }
    Canvas canvas;
    canvas.path_ = path;
    canvas.is_png_ = isPng(path);
    canvas.surface_.reset(canvas.is_png_
                              ? cairo_image_surface_create(CAIRO_FORMAT_RGB24, static_cast<int>(width),
                                                           static_cast<int>(height))
                              : cairo_svg_surface_create(path.c_str(), width, height));
    canvas.context_.reset(cairo_create(canvas.surface_.get()));
    cairo_t *cr = canvas.cairo();
    cairo_set_source_rgb(cr, 1, 1, 1);
    cairo_paint(cr);
    cairo_select_font_face(cr, "sans-serif", CAIRO_FONT_SLANT_NORMAL, CAIRO_FONT_WEIGHT_NORMAL);
    cairo_set_font_size(cr, 13);
    return canvas;
}

Result<> Canvas::write() {
    context_.reset();
    cairo_status_t status = CAIRO_STATUS_SUCCESS;
    if (is_png_) {
        status = cairo_surface_write_to_png(surface_.get(), path_.c_str());
    } else {
        cairo_surface_finish(surface_.get());
        status = cairo_surface_status(surface_.get());
    }
    if (status != CAIRO_STATUS_SUCCESS) {
        return fail("cannot write the picture '" + path_ + "': " + cairo_status_to_string(status));
    }
    return {};
}

void Canvas::set_color(double red, double green, double blue, double alpha) const {
    cairo_set_source_rgba(cairo(), red, green, blue, alpha);
}

void Canvas::text(double x, double y, const std::string &text, double size) const {
    cairo_set_font_size(cairo(), size);
    cairo_move_to(cairo(), x, y);
    cairo_show_text(cairo(), text.c_str());
}

double Canvas::text_width(const std::string &text, double size) const {
    cairo_set_font_size(cairo(), size);
    cairo_text_extents_t extents;
    cairo_text_extents(cairo(), text.c_str(), &extents);
    return extents.x_advance;
}

void Canvas::line(double x1, double y1, double x2, double y2, double width) const {
    cairo_set_line_width(cairo(), width);
    cairo_move_to(cairo(), x1, y1);
    cairo_line_to(cairo(), x2, y2);
    cairo_stroke(cairo());
}

}  // namespace mw::charts

// SPDX-License-Identifier: GPL-2.0-or-later
// A picture file being drawn with cairo.
#pragma once

#include <cairo.h>

#include <memory>
#include <string>

#include "base/result.hh"

namespace mw::charts {

class Canvas {
  public:
    /// An empty white picture [pixels] for the file `path`: .png or .svg. Any other extension is an error.
    static Result<Canvas> open(const std::string &path, double width, double height);

    /// Reports the errors that open() and write() would report: another extension, a folder that does not
    /// exist or is not writable.
    static Result<> check(const std::string &path);

    cairo_t *cairo() const noexcept { return context_.get(); }
    /// Writes the file; an error when it cannot be written.
    Result<> write();

    void set_color(double red, double green, double blue, double alpha = 1.0) const;
    void text(double x, double y, const std::string &text, double size = 13) const;
    double text_width(const std::string &text, double size = 13) const;
    void line(double x1, double y1, double x2, double y2, double width = 1.0) const;

  private:
    Canvas() = default;
    struct FreeSurface {
        void operator()(cairo_surface_t *surface) const { cairo_surface_destroy(surface); }
    };
    struct FreeContext {
        void operator()(cairo_t *context) const { cairo_destroy(context); }
    };
    std::string path_;
    bool is_png_ = false;
    std::unique_ptr<cairo_surface_t, FreeSurface> surface_;
    std::unique_ptr<cairo_t, FreeContext> context_;
};

}  // namespace mw::charts

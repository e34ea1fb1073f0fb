// SPDX-License-Identifier: GPL-2.0-or-later
#include "base/charts/chart.hh"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "base/charts/canvas.hh"

namespace mw::charts {

namespace {

constexpr double WIDTH = 1400, LEFT = 90, RIGHT = 210, TOP = 56, BOTTOM = 46;
constexpr double STRIP = 130, DIGITAL_STRIP = 48, GAP = 12, HISTOGRAM = 300;

struct Color {
    double red, green, blue;
};
constexpr std::array<Color, 6> COLORS{{{0.10, 0.30, 0.65},
                                       {0.80, 0.30, 0.15},
                                       {0.10, 0.50, 0.25},
                                       {0.55, 0.25, 0.60},
                                       {0.65, 0.50, 0.05},
                                       {0.15, 0.50, 0.60}}};

struct Range {
    double low, high;
};

Range range_of(const Curve &curve) {
    if (curve.digital) {
        return {-0.15, 1.15};
    }
    Range range{1e300, -1e300};
    for (const double value : curve.values) {
        if (std::isfinite(value)) {
            range = {std::min(range.low, value), std::max(range.high, value)};
        }
    }
    if (range.low > range.high) {
        return {-1, 1};
    }
    const double margin =
        range.high > range.low ? 0.05 * (range.high - range.low) : std::max(0.5, std::abs(range.low) * 0.05);
    return {range.low - margin, range.high + margin};
}

struct Frame {
    double left, top, width, height;
    Range x, y;

    double px(double value) const { return left + (value - x.low) / (x.high - x.low) * width; }
    double py(double value) const { return top + height - (value - y.low) / (y.high - y.low) * height; }
};

void draw_grid(const Canvas &canvas, const Frame &frame, bool has_ticks) {
    canvas.set_color(0.88, 0.88, 0.88);
    for (const double x : round_ticks(frame.x.low, frame.x.high, 10)) {
        canvas.line(frame.px(x), frame.top, frame.px(x), frame.top + frame.height, 0.7);
    }
    if (has_ticks) {
        for (const double y : round_ticks(frame.y.low, frame.y.high, 4)) {
            canvas.set_color(0.88, 0.88, 0.88);
            canvas.line(frame.left, frame.py(y), frame.left + frame.width, frame.py(y), 0.7);
            canvas.set_color(0.3, 0.3, 0.3);
            const std::string label = fmt::format("{:g}", y);
            canvas.text(frame.left - 8 - canvas.text_width(label, 11), frame.py(y) + 4, label, 11);
        }
    }
    canvas.set_color(0.5, 0.5, 0.5);
    cairo_rectangle(canvas.cairo(), frame.left, frame.top, frame.width, frame.height);
    cairo_set_line_width(canvas.cairo(), 0.8);
    cairo_stroke(canvas.cairo());
}

void draw_curve(const Canvas &canvas, const Frame &frame, const std::vector<double> &times,
                const Curve &curve, Color color) {
    cairo_t *cr = canvas.cairo();
    canvas.set_color(color.red, color.green, color.blue);
    cairo_set_line_width(cr, 1.3);
    bool down = false;
    double last_y = 0;
    for (std::size_t i = 0; i < times.size() && i < curve.values.size(); ++i) {
        if (!std::isfinite(curve.values[i])) {
            down = false;
            continue;
        }
        const double x = frame.px(times[i]), y = frame.py(curve.values[i]);
        if (down && curve.digital) {
            cairo_line_to(cr, x, last_y);
        }
        (down ? cairo_line_to : cairo_move_to)(cr, x, y);
        down = true;
        last_y = y;
    }
    cairo_stroke(cr);
}

void draw_time_axis(const Canvas &canvas, const Frame &frame) {
    canvas.set_color(0.3, 0.3, 0.3);
    const double span = frame.x.high - frame.x.low;
    const double factor = span < 0.2 ? 1e3 : 1.0;
    for (const double x : round_ticks(frame.x.low, frame.x.high, 10)) {
        const std::string label = fmt::format("{:g}", x * factor);
        canvas.text(frame.px(x) - canvas.text_width(label, 11) / 2, frame.top + frame.height + 16, label, 11);
    }
    canvas.text(frame.left + frame.width + 10, frame.top + frame.height + 16, factor > 1 ? "ms" : "s", 11);
}

double log_height(double count) {
    return count > 0 ? std::log10(count) + 0.3 : 0.0;
}

void draw_histogram(const Canvas &canvas, const Histogram &histogram, double top) {
    const auto bins = static_cast<double>(histogram.counts.size());
    double most = 1;
    for (const double count : histogram.counts) {
        most = std::max(most, count);
    }
    const Frame frame{LEFT,
                      top + 30,
                      WIDTH - LEFT - 60,
                      HISTOGRAM - 80,
                      {histogram.first, histogram.first + bins * histogram.bin_width},
                      {0, log_height(most) * 1.05}};
    canvas.set_color(0.1, 0.1, 0.1);
    canvas.text(LEFT, top + 16, histogram.title, 15);
    draw_grid(canvas, frame, false);
    for (double count = 1; count <= most; count *= 10) {
        canvas.set_color(0.3, 0.3, 0.3);
        const std::string label = fmt::format("{:g}", count);
        canvas.text(LEFT - 8 - canvas.text_width(label, 11), frame.py(log_height(count)) + 4, label, 11);
    }
    canvas.set_color(COLORS[0].red, COLORS[0].green, COLORS[0].blue);
    for (std::size_t i = 0; i < histogram.counts.size(); ++i) {
        const double x = histogram.first + static_cast<double>(i) * histogram.bin_width;
        const double y = frame.py(log_height(histogram.counts[i]));
        cairo_rectangle(canvas.cairo(), frame.px(x), y, frame.px(x + histogram.bin_width) - frame.px(x),
                        frame.top + frame.height - y);
    }
    cairo_fill(canvas.cairo());
    canvas.set_color(0.3, 0.3, 0.3);
    for (const double x : round_ticks(frame.x.low, frame.x.high, 10)) {
        const std::string label = fmt::format("{:g}", x);
        canvas.text(frame.px(x) - canvas.text_width(label, 11) / 2, frame.top + frame.height + 16, label, 11);
    }
    canvas.text(LEFT, frame.top + frame.height + 34,
                fmt::format("{}; below the bins: {:g}, above: {:g}", histogram.unit, histogram.below,
                            histogram.above),
                11);
}

}  // namespace

std::vector<double> round_ticks(double low, double high, int wanted) {
    const double raw = (high - low) / std::max(1, wanted);
    const double power = std::pow(10.0, std::floor(std::log10(raw)));
    const double scaled = raw / power;
    const double step = power * (scaled <= 1.0 ? 1.0 : scaled <= 2.0 ? 2.0 : scaled <= 5.0 ? 5.0 : 10.0);
    std::vector<double> ticks;
    for (double n = std::ceil(low / step); n * step <= high && ticks.size() < 1000; n += 1.0) {
        ticks.push_back(n == 0.0 ? 0.0 : n * step);
    }
    return ticks;
}

Result<> draw_strips(const StripChart &chart, const std::string &path) {
    double height = TOP + BOTTOM;
    for (const Curve &curve : chart.curves) {
        height += (curve.digital ? DIGITAL_STRIP : STRIP) + GAP;
    }
    auto canvas = Canvas::open(path, WIDTH, height);
    if (!canvas) {
        return std::unexpected(canvas.error());
    }
    canvas->set_color(0.1, 0.1, 0.1);
    canvas->text(LEFT, 32, chart.title, 17);
    Range times{0, 1};
    if (chart.times_s.size() > 1) {
        times = {chart.times_s.front(), chart.times_s.back()};
    }
    if (!(times.high > times.low)) {
        times.high = times.low + 1;
    }
    double top = TOP;
    for (std::size_t i = 0; i < chart.curves.size(); ++i) {
        const Curve &curve = chart.curves[i];
        const double strip = curve.digital ? DIGITAL_STRIP : STRIP;
        const Frame frame{LEFT, top, WIDTH - LEFT - RIGHT, strip, times, range_of(curve)};
        const Color color = COLORS[i % COLORS.size()];
        draw_grid(*canvas, frame, !curve.digital);
        if (chart.trigger_s >= times.low && chart.trigger_s <= times.high) {
            canvas->set_color(0.9, 0.1, 0.1, 0.6);
            canvas->line(frame.px(chart.trigger_s), top, frame.px(chart.trigger_s), top + strip, 1.0);
        }
        draw_curve(*canvas, frame, chart.times_s, curve, color);
        canvas->text(WIDTH - RIGHT + 10, top + strip / 2 + 4, curve.name, 12);
        if (i + 1 == chart.curves.size()) {
            draw_time_axis(*canvas, frame);
        }
        top += strip + GAP;
    }
    return canvas->write();
}

Result<> draw_histograms(const std::vector<Histogram> &histograms, const std::string &path) {
    auto canvas = Canvas::open(path, WIDTH, HISTOGRAM * static_cast<double>(histograms.size()) + 20);
    if (!canvas) {
        return std::unexpected(canvas.error());
    }
    double top = 10;
    for (const Histogram &histogram : histograms) {
        draw_histogram(*canvas, histogram, top);
        top += HISTOGRAM;
    }
    return canvas->write();
}

}  // namespace mw::charts

// SPDX-License-Identifier: GPL-2.0-or-later
// raster: the power of a laser from lines of pixels, as a position passes over them. The manual page tells
// the format of the lines.
#include <cmath>

#include "components/common/kit.hh"
#include "components/machine/raster_core.hh"

namespace mw::components {

enum RasterState : std::int32_t {
    RASTER_IDLE,
    RASTER_HEADER,
    RASTER_PIXELS,
    RASTER_READY,
    RASTER_RUNNING,
    RASTER_FAULT
};
enum RasterFault : std::int32_t { FAULT_NONE, FAULT_HEADER, FAULT_PIXEL, FAULT_NO_LINE, FAULT_POSITION };

constexpr int BYTES_PER_RUN = 256;

struct Raster {
    hal_port_t *program = nullptr;
    In<bool> run, reset;
    In<double> position;
    Out<double> output, fraction, bitmap_position;
    Out<bool> enabled, fault;
    Out<std::int32_t> state, fault_code, current_pixel_index, previous_pixel_value, current_pixel_value;
    raster::Line line;
    double start = 0.0;
    bool last_run = false;

    void declare(Declare &d) noexcept;
    void update() noexcept;

  private:
    void read_line() noexcept;
    void begin() noexcept;
    void fail(RasterFault code) noexcept {
        state = RASTER_FAULT;
        fault_code = code;
    }
    void show() noexcept;
};

void Raster::declare(Declare &d) noexcept {
    Name name;
    rtapi_snprintf(name.text, sizeof name.text, "%s.program", d.prefix());
    d.keep(hal_pin_port_new(name.text, HAL_IN, &program, d.comp_id()));
    d.pin(run, "run");
    d.pin(reset, "reset");
    d.pin(position, "position");
    d.pin(output, "output");
    d.pin(enabled, "enabled");
    d.pin(state, "state");
    d.pin(fault, "fault");
    d.pin(fault_code, "fault-code");
    d.pin(fraction, "fraction");
    d.pin(bitmap_position, "bitmap-position");
    d.pin(current_pixel_index, "current-pixel-index", -1);
    d.pin(previous_pixel_value, "previous-pixel-value");
    d.pin(current_pixel_value, "current-pixel-value");
    d.function<&Raster::update>(this);
}

/// Reads from the port until a line is complete.
void Raster::read_line() noexcept {
    char byte = '\0';
    for (int i = 0; i < BYTES_PER_RUN && state <= RASTER_PIXELS; ++i) {
        if (hal_port_readable(program) == 0 || !hal_port_read(program, &byte, 1)) {
            return;
        }
        line.take(byte);
        switch (line.reading()) {
        case raster::Reading::NOTHING: state = RASTER_IDLE; break;
        case raster::Reading::HEADER: state = RASTER_HEADER; break;
        case raster::Reading::PIXELS: state = RASTER_PIXELS; break;
        case raster::Reading::COMPLETE: state = RASTER_READY; break;
        case raster::Reading::BAD_HEADER: fail(FAULT_HEADER); break;
        case raster::Reading::BAD_PIXEL: fail(FAULT_PIXEL); break;
        }
    }
}

void Raster::begin() noexcept {
    start = position;
    current_pixel_index = -1;
    if (state != RASTER_READY) {
        fail(FAULT_NO_LINE);
    } else if (!std::isfinite(start)) {
        fail(FAULT_POSITION);
    } else {
        state = RASTER_RUNNING;
    }
}

/// The pixel under the position; no power beside the line.
void Raster::show() noexcept {
    const double at = position;
    if (!std::isfinite(at)) {
        fail(FAULT_POSITION);
        return;
    }
    const double way = (at - start - line.offset()) * line.pixels_per_unit();
    const bool isInside = way >= 0.0 && way < line.count();
    const int index = isInside ? static_cast<int>(way) : -1;
    const int value = isInside ? line.pixel(index) : 0;
    bitmap_position = way;
    fraction = way / line.count();
    if (index != current_pixel_index) {
        previous_pixel_value = current_pixel_value.get();
        current_pixel_index = index;
        current_pixel_value = value;
    }
    output = static_cast<double>(value) / line.full_scale();
}

void Raster::update() noexcept {
    const bool isRun = run;
    if (reset) {
        state = RASTER_IDLE;
        fault_code = FAULT_NONE;
        line.clear();
        hal_port_clear(program);
    } else {
        read_line();
        if (isRun && !last_run && state != RASTER_FAULT) {
            begin();
        } else if (!isRun && state == RASTER_RUNNING) {
            state = RASTER_IDLE;
            line.clear();
        }
    }
    last_run = isRun;
    if (state == RASTER_RUNNING) {
        show();
    }
    enabled = state == RASTER_RUNNING;
    if (!enabled) {
        output = 0.0;
    }
    fault = state == RASTER_FAULT;
}

}  // namespace mw::components

MW_INSTANCES(Raster, "raster");

// SPDX-License-Identifier: GPL-2.0-or-later
// raster: the power of a laser from lines of pixels, as a position passes over them. The manual page has
// the format of the lines.
#include <cmath>

#include "components/machine/raster_core.hh"
#include "hal/sdk/component.hh"

namespace mw::components {
using namespace sdk;

enum RasterState : std::int32_t {
    RASTER_IDLE,
    RASTER_HEADER,
    RASTER_PIXELS,
    RASTER_READY,
    RASTER_RUNNING,
    RASTER_FAULT
};
enum RasterFault : std::int32_t {
    FAULT_NONE,
    FAULT_OFFSET,
    FAULT_BITS,
    FAULT_SCALE,
    FAULT_COUNT,
    FAULT_PIXEL,
    FAULT_POSITION
};

constexpr int BYTES_PER_RUN = 256;

struct Raster {
    hal_port_t *program = nullptr;
    In<bool> run, reset;
    In<double> position;
    Out<double> output, fraction, bitmap_position, previous_pixel_value, current_pixel_value;
    Out<double> program_offset, ppu;
    Out<bool> enabled, fault;
    Out<std::int32_t> state, fault_code, current_pixel_index, bpp, count;
    raster::Line line;
    double start = 0.0;
    bool last_run = false;
    bool isAwaited = false;  ///< run is true, but the line is not yet complete

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
    d.pin(output, "output", raster::NO_PIXEL);
    d.pin(enabled, "enabled");
    d.pin(state, "state");
    d.pin(fault, "fault");
    d.pin(fault_code, "fault-code");
    d.pin(fraction, "fraction");
    d.pin(bitmap_position, "bitmap-position");
    d.pin(current_pixel_index, "current-pixel-index", -1);
    d.pin(previous_pixel_value, "previous-pixel-value");
    d.pin(current_pixel_value, "current-pixel-value");
    d.pin(program_offset, "program-offset");
    d.pin(bpp, "bpp");
    d.pin(ppu, "ppu");
    d.pin(count, "count");
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
        case raster::Reading::BAD_OFFSET: fail(FAULT_OFFSET); break;
        case raster::Reading::BAD_BITS: fail(FAULT_BITS); break;
        case raster::Reading::BAD_SCALE: fail(FAULT_SCALE); break;
        case raster::Reading::BAD_COUNT: fail(FAULT_COUNT); break;
        case raster::Reading::BAD_PIXEL: fail(FAULT_PIXEL); break;
        }
    }
}

void Raster::begin() noexcept {
    isAwaited = false;
    current_pixel_index = -1;
    program_offset = line.offset();
    bpp = line.bits();
    ppu = line.pixels_per_unit();
    count = line.count();
    state = RASTER_RUNNING;
}

/// The power at this position, interpolated between the two neighbouring pixels; none outside the line.
void Raster::show() noexcept {
    const double at = position;
    if (!std::isfinite(at) || !std::isfinite(start)) {
        fail(FAULT_POSITION);
        return;
    }
    const double way = line.way(at - start);
    const bool inside = way >= 0.0 && way <= line.count() - 1;
    const int before = inside ? static_cast<int>(way) : 0;
    const int behind = before + 1 < line.count() ? before + 1 : before;
    const double first = inside ? line.percent(before) : raster::NO_PIXEL;
    const double second = inside ? line.percent(behind) : raster::NO_PIXEL;
    bitmap_position = way;
    fraction = inside ? way - before : 0.0;
    current_pixel_index = inside ? behind : -1;
    previous_pixel_value = first;
    current_pixel_value = second;
    const bool dark = first < 0.0 || second < 0.0;
    output = dark ? raster::NO_PIXEL : first + (second - first) * (way - before);
}

void Raster::update() noexcept {
    const bool is_run = run;
    if (reset) {
        state = RASTER_IDLE;
        fault_code = FAULT_NONE;
        isAwaited = false;
        line.clear();
        hal_port_clear(program);
    } else {
        read_line();
        if (is_run && !last_run) {
            start = position;
            isAwaited = true;
        }
        isAwaited = isAwaited && is_run;
        if (isAwaited && state == RASTER_READY) {
            begin();
        } else if (!is_run && state == RASTER_RUNNING) {
            state = RASTER_IDLE;
            line.clear();
        }
    }
    last_run = is_run;
    if (state == RASTER_RUNNING) {
        show();
    }
    enabled = state == RASTER_RUNNING;
    if (!enabled) {
        output = raster::NO_PIXEL;
    }
    fault = state == RASTER_FAULT;
}

}  // namespace mw::components

MW_COMPONENT(mw::components::Raster, "raster", mw::sdk::MANY);

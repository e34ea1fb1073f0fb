// SPDX-License-Identifier: GPL-2.0-or-later
// raster: the power of a laser from lines of pixels, as a position passes over them. The manual page tells
// the format of the lines.
#include <cmath>

#include "components/common/kit.hh"

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

constexpr int MAX_PIXELS = 32768;
constexpr int MAX_HEADER = 96;
constexpr int BYTES_PER_RUN = 256;

struct Raster {
    hal_port_t *program = nullptr;
    In<bool> run, reset;
    In<double> position;
    Out<double> output, fraction, bitmap_position;
    Out<bool> enabled, fault;
    Out<std::int32_t> state, fault_code, current_pixel_index, previous_pixel_value, current_pixel_value;

    char header[MAX_HEADER] = {};
    int header_size = 0;
    double offset = 0.0;
    double pixels_per_unit = 0.0;
    int digits = 0;  ///< hexadecimal, of a pixel
    int count = 0;
    int pixels = 0;  ///< read so far
    int digit = 0;
    std::uint16_t pixel[MAX_PIXELS] = {};
    double start = 0.0;
    bool last_run = false;

    void declare(Declare &d) noexcept;
    void update() noexcept;

  private:
    void read_line() noexcept;
    void take_header_byte(char byte) noexcept;
    void take_pixel_byte(char byte) noexcept;
    bool parse_header() noexcept;
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

namespace {

/// A decimal number up to `end`; moves behind the character there. False when there is none.
bool read_number(const char *&text, char end, double &out) noexcept {
    const bool isNegative = *text == '-';
    text += isNegative ? 1 : 0;
    double number = 0.0;
    double place = 0.0;
    bool hasDigit = false;
    for (; *text != end; ++text) {
        if (*text == '.' && place == 0.0) {
            place = 1.0;
            continue;
        }
        if (*text < '0' || *text > '9') {
            return false;
        }
        hasDigit = true;
        number = 10.0 * number + (*text - '0');
        place *= 10.0;
    }
    ++text;
    number = place > 1.0 ? number / place : number;
    out = isNegative ? -number : number;
    return hasDigit;
}

}  // namespace

/// offset;bits;pixels per unit;count
bool Raster::parse_header() noexcept {
    header[header_size] = '\n';
    const char *text = header;
    double bits = 0.0;
    double number = 0.0;
    const bool isRead = read_number(text, ';', offset) && read_number(text, ';', bits) &&
                        read_number(text, ';', pixels_per_unit) && read_number(text, '\n', number);
    const bool isPossible = isRead && (bits == 4.0 || bits == 8.0 || bits == 12.0 || bits == 16.0) &&
                            pixels_per_unit != 0.0 && number >= 1.0 && number <= MAX_PIXELS &&
                            number == std::floor(number);
    digits = isPossible ? static_cast<int>(bits) / 4 : 0;
    count = isPossible ? static_cast<int>(number) : 0;
    return isPossible;
}

void Raster::take_header_byte(char byte) noexcept {
    if (byte == '\n') {
        pixels = 0;
        digit = 0;
        if (parse_header()) {
            state = RASTER_PIXELS;
        } else {
            fail(FAULT_HEADER);
        }
    } else if (header_size >= MAX_HEADER - 1) {
        fail(FAULT_HEADER);
    } else {
        header[header_size++] = byte;
    }
}

void Raster::take_pixel_byte(char byte) noexcept {
    const char lower = static_cast<char>(byte | 0x20);
    const bool isDecimal = byte >= '0' && byte <= '9';
    const bool isLetter = lower >= 'a' && lower <= 'f';
    if (!isDecimal && !isLetter) {
        fail(FAULT_PIXEL);
        return;
    }
    const unsigned nibble = static_cast<unsigned>(isDecimal ? byte - '0' : lower - 'a' + 10);
    pixel[pixels] = static_cast<std::uint16_t>(digit == 0 ? nibble : (pixel[pixels] << 4U | nibble));
    if (++digit == digits) {
        digit = 0;
        if (++pixels == count) {
            state = RASTER_READY;
        }
    }
}

/// Reads from the port until a line is complete.
void Raster::read_line() noexcept {
    for (int i = 0; i < BYTES_PER_RUN; ++i) {
        const bool isReading = state == RASTER_IDLE || state == RASTER_HEADER || state == RASTER_PIXELS;
        char byte = '\0';
        if (!isReading || hal_port_readable(program) == 0 || !hal_port_read(program, &byte, 1)) {
            return;
        }
        if (state == RASTER_IDLE && byte != '\n') {
            header_size = 0;
            state = RASTER_HEADER;
        }
        if (state == RASTER_HEADER) {
            take_header_byte(byte);
        } else if (state == RASTER_PIXELS && byte != '\n') {
            take_pixel_byte(byte);
        }
    }
}

/// The pixel under the position; no power beside the line.
void Raster::show() noexcept {
    const double at = position;
    if (!std::isfinite(at)) {
        fail(FAULT_POSITION);
        return;
    }
    const double way = (at - start - offset) * pixels_per_unit;
    bitmap_position = way;
    fraction = way / count;
    const bool isInside = way >= 0.0 && way < count;
    const int index = isInside ? static_cast<int>(way) : -1;
    if (index != current_pixel_index) {
        previous_pixel_value = current_pixel_value.get();
        current_pixel_index = index;
        current_pixel_value = isInside ? pixel[index] : 0;
    }
    const double full = static_cast<double>((1U << (4U * static_cast<unsigned>(digits))) - 1U);
    output = isInside ? pixel[index] / full : 0.0;
}

void Raster::update() noexcept {
    const bool isRun = run;
    if (reset) {
        state = RASTER_IDLE;
        fault_code = FAULT_NONE;
        hal_port_clear(program);
    } else {
        read_line();
        if (isRun && !last_run && state != RASTER_FAULT) {
            start = position;
            current_pixel_index = -1;
            if (state == RASTER_READY && std::isfinite(start)) {
                state = RASTER_RUNNING;
            } else {
                fail(FAULT_NO_LINE);
            }
        } else if (!isRun && state == RASTER_RUNNING) {
            state = RASTER_IDLE;
        }
    }
    last_run = isRun;
    enabled = state == RASTER_RUNNING;
    if (state == RASTER_RUNNING) {
        show();
    }
    if (state != RASTER_RUNNING) {
        output = 0.0;
        enabled = false;
    }
    fault = state == RASTER_FAULT;
}

}  // namespace mw::components

MW_INSTANCES(Raster, "raster");

// SPDX-License-Identifier: GPL-2.0-or-later
// The canonical devices of HAL drivers: digital input and output, analog input and output, encoder. Each has
// the pins and parameters of LinuxCNC's "Canonical Device Interfaces" and is a member of a driver's instance:
//
//     mw::sdk::DigitalIn limit;
//     limit.declare(d, "digin-00.");     // board.0.digin-00.in, board.0.digin-00.in-not
//     limit.read(isHigh);                // in the driver's read function
//
// A prefix contains its separator. `declare` runs while loading and returns 0 or a negated errno, which the
// Declare keeps too, so that the load fails. The driver's thread calls `read` and `write`, which neither
// allocate nor wait. docs/integrator/hal/drivers.md explains the devices with an example.
#pragma once

#include "component.hh"
#include "device_values.hh"

namespace mw::sdk {

/// PREFIX with the number of a channel: numbered("pin-%02d-", 2) is "pin-02-". [while loading]
inline Name numbered(const char *format, int number) noexcept {
    Name name;
    rtapi_snprintf(name.text, sizeof name.text, format, number);
    return name;
}

/// PREFIX and NAME joined; `d` keeps an error. [while loading]
inline Name joined(Declare &d, const char *prefix, const char *name) noexcept {
    Name full;
    if (rtapi_snprintf(full.text, sizeof full.text, "%s%s", prefix, name) > HAL_NAME_LEN) {
        rtapi_print_msg(RTAPI_MSG_ERR, "%s: HAL name %s%s is longer than %d characters", d.prefix(), prefix,
                        name, HAL_NAME_LEN);
        d.keep(-EINVAL);
    }
    return full;
}

/// Names of the pins of a digital input, for drivers with different names.
struct DigitalInNames {
    const char *in = "in";
    const char *in_not = "in-not";
};

/// Pins `in` and `in-not` (bit, out).
struct DigitalIn {
    Out<bool> in, in_not;

    int declare(Declare &d, const char *prefix, const DigitalInNames &names = {}) noexcept {
        d.pin(in, joined(d, prefix, names.in).text);
        d.pin(in_not, joined(d, prefix, names.in_not).text);
        return d.status();
    }
    /// Sets the state of the hardware input.
    void read(bool is_high) noexcept {
        in = is_high;
        in_not = !is_high;
    }
};

struct DigitalOutNames {
    const char *out = "out";
    const char *invert = "invert";
};

/// Pin `out` (bit, in), parameter `invert` (bit, rw).
struct DigitalOut {
    In<bool> out;
    ParamRw<bool> invert;

    int declare(Declare &d, const char *prefix, const DigitalOutNames &names = {}) noexcept {
        d.pin(out, joined(d, prefix, names.out).text);
        d.param(invert, joined(d, prefix, names.invert).text);
        return d.status();
    }
    /// Returns the state for the hardware output.
    bool write() const noexcept { return out.get() != invert.get(); }
};

/// Pin `value` (float, out); parameters `scale`, `offset`, `bit-weight`, `hw-offset` (float, rw).
struct AnalogIn {
    Out<double> value;
    ParamRw<double> scale, offset, bit_weight, hw_offset;

    int declare(Declare &d, const char *prefix, const ConverterRange &range = {}) noexcept {
        d.pin(value, joined(d, prefix, "value").text);
        d.param(scale, joined(d, prefix, "scale").text, 1.0);
        d.param(offset, joined(d, prefix, "offset").text);
        d.param(bit_weight, joined(d, prefix, "bit-weight").text, range.bit_weight);
        d.param(hw_offset, joined(d, prefix, "hw-offset").text, range.hw_offset);
        return d.status();
    }
    /// Sets a reading [V]: value = reading * scale - offset. A result that is not finite leaves `value`
    /// unchanged.
    void read(double reading) noexcept { set_finite(value, scaled_input(reading, scale, offset)); }
    /// Sets a code of the converter: reading = code * bit-weight - hw-offset.
    void read_code(std::int32_t code) noexcept {
        read(converter_reading(code, {.bit_weight = bit_weight, .hw_offset = hw_offset}));
    }
};

/// Pins `value` (float, in) and `enable` (bit, in); parameters `scale`, `offset`, `high-limit`, `low-limit`,
/// `bit-weight`, `hw-offset` (float, rw).
struct AnalogOut {
    In<double> value;
    In<bool> enable;
    ParamRw<double> scale, offset, high_limit, low_limit, bit_weight, hw_offset;
    double range_low = 0.0, range_high = 0.0;  ///< range of the hardware [V]

    int declare(Declare &d, const char *prefix, const ConverterRange &range = {}) noexcept {
        range_low = range.low;
        range_high = range.high;
        d.pin(value, joined(d, prefix, "value").text);
        d.pin(enable, joined(d, prefix, "enable").text);
        d.param(scale, joined(d, prefix, "scale").text, 1.0);
        d.param(offset, joined(d, prefix, "offset").text);
        d.param(high_limit, joined(d, prefix, "high-limit").text, range.high);
        d.param(low_limit, joined(d, prefix, "low-limit").text, range.low);
        d.param(bit_weight, joined(d, prefix, "bit-weight").text, range.bit_weight);
        d.param(hw_offset, joined(d, prefix, "hw-offset").text, range.hw_offset);
        return d.status();
    }
    /// Output voltage [V]: scale * value + offset within the limits; 0 while `enable` is FALSE or a value is
    /// not finite.
    double write() const noexcept {
        return enable ? scaled_output(value, {scale, offset, low_limit, high_limit},
                                      {.low = range_low, .high = range_high})
                      : 0.0;
    }
    /// Output as a code of the converter: (volts - hw-offset) / bit-weight.
    std::int32_t write_code() const noexcept {
        return converter_code(write(), {.bit_weight = bit_weight, .hw_offset = hw_offset});
    }
};

/// Capabilities of an encoder's hardware.
struct EncoderHardware {
    int counter_bits = 32;
    double max_index_vel =
        0.0;  ///< maximum speed at which the index is exact to one count [counts/s]; 0: not known
    double velocity_resolution = 0.0;  ///< [counts/s]
};

/// Pins `count`, `rawcounts` (s32, out), `position`, `velocity` (float, out), `reset` (bit, in),
/// `index-enable` (bit, I/O); parameter `scale` (float, rw), `max-index-vel`, `velocity-resolution` (float,
/// ro).
struct EncoderIn {
    Out<std::int32_t> count, rawcounts;
    Out<double> position, velocity;
    In<bool> reset;
    InOut<bool> index_enable;
    ParamRw<double> scale;
    ParamRo<double> max_index_vel, velocity_resolution;
    EncoderCount counts;

    int declare(Declare &d, const char *prefix, const EncoderHardware &hardware = {}) noexcept {
        counts = EncoderCount(hardware.counter_bits);
        d.pin(count, joined(d, prefix, "count").text);
        d.pin(rawcounts, joined(d, prefix, "rawcounts").text);
        d.pin(position, joined(d, prefix, "position").text);
        d.pin(velocity, joined(d, prefix, "velocity").text);
        d.pin(reset, joined(d, prefix, "reset").text);
        d.pin(index_enable, joined(d, prefix, "index-enable").text);
        d.param(scale, joined(d, prefix, "scale").text, 1.0);
        d.param(max_index_vel, joined(d, prefix, "max-index-vel").text, hardware.max_index_vel);
        d.param(velocity_resolution, joined(d, prefix, "velocity-resolution").text,
                hardware.velocity_resolution);
        return d.status();
    }
    /// True if the hardware must latch its counter at the next index.
    bool isIndexWanted() const noexcept { return index_enable; }
    /// Sets a reading; velocity is the change per period.
    void read(const EncoderReading &reading, long period_ns) noexcept {
        const EncoderCount::Result result = take(reading);
        if (period_ns > 0) {
            show_velocity(static_cast<double>(result.change) / seconds(period_ns));
        }
    }
    /// Sets a reading of hardware that measures the velocity itself [counts/s].
    void read_with_velocity(const EncoderReading &reading, double counts_per_s) noexcept {
        take(reading);
        show_velocity(counts_per_s);
    }

  private:
    EncoderCount::Result take(const EncoderReading &reading) noexcept {
        const EncoderCount::Result result = counts.read(reading, {reset, index_enable});
        rawcounts = shown_count(result.raw);
        count = shown_count(result.count);
        set_finite(position, static_cast<double>(result.count) / usable_scale(scale));
        // Written last, so that a reader that sees FALSE also sees the position from the index.
        if (result.index_taken) {
            index_enable = false;
        }
        return result;
    }
    void show_velocity(double counts_per_s) noexcept {
        set_finite(velocity, counts_per_s / usable_scale(scale));
    }
};

}  // namespace mw::sdk

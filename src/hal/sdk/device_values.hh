// SPDX-License-Identifier: GPL-2.0-or-later
// The arithmetic of the canonical devices, without HAL: scales, limits, counters that overflow, index and
// reset.
#pragma once

#include <cstdint>

namespace mw::sdk {

/// FALSE for infinite values and NaN.
constexpr bool isFinite(double value) noexcept {
    return value - value == 0.0;
}

/// A scale that is 0, infinite or NaN counts as 1, as in LinuxCNC.
constexpr double usable_scale(double scale) noexcept {
    return isFinite(scale) && scale != 0.0 ? scale : 1.0;
}

/// Properties of a converter, in its own units [V, or mA]. The output is limited to `low` and `high`.
struct ConverterRange {
    double low = -10.0;
    double high = 10.0;
    double bit_weight = 1.0;  ///< one least significant bit [V or mA]
    double hw_offset = 0.0;   ///< input: reading at 0 V; output: voltage for code 0
};

struct OutputScaling {
    double scale = 1.0;
    double offset = 0.0;
    double low_limit = 0.0;
    double high_limit = 0.0;
};

/// scale * value + offset within the limits and the converter's range [V]. 0 when a value is not finite or
/// the limits exclude each other: such an output must not cause motion.
constexpr double scaled_output(double value, const OutputScaling &scaling,
                               const ConverterRange &range) noexcept {
    const double low = scaling.low_limit > range.low ? scaling.low_limit : range.low;
    const double high = scaling.high_limit < range.high ? scaling.high_limit : range.high;
    const double wanted = usable_scale(scaling.scale) * value + scaling.offset;
    const bool defined = isFinite(wanted) && isFinite(scaling.scale) && low <= high &&
                         scaling.low_limit == scaling.low_limit && scaling.high_limit == scaling.high_limit;
    if (!defined) {
        return 0.0;
    }
    return wanted < low ? low : (wanted > high ? high : wanted);
}

/// reading * scale - offset. May not be finite.
constexpr double scaled_input(double reading, double scale, double offset) noexcept {
    return reading * usable_scale(scale) - offset;
}

/// Extends a hardware counter of `bits` bits across overflows. Correct while it changes by less than half of
/// its range between two calls.
class CounterExtension {
  public:
    explicit constexpr CounterExtension(int bits = 32) noexcept
        : shift_(bits < 1 ? 31 : (bits > 32 ? 0 : 32 - bits)) {}

    /// The total count for `hardware`. The first call sets it to the counter's signed value.
    constexpr std::int64_t follow(std::uint32_t hardware) noexcept {
        if (!started_) {
            started_ = true;
            total_ = signed_part(hardware);
        } else {
            total_ = near(hardware);
        }
        return total_;
    }
    /// The total count at `hardware`, a latched value close to the last one.
    constexpr std::int64_t near(std::uint32_t hardware) const noexcept {
        return total_ + signed_part(hardware - static_cast<std::uint32_t>(total_));
    }
    constexpr std::int64_t total() const noexcept { return total_; }
    constexpr bool hasStarted() const noexcept { return started_; }

  private:
    constexpr std::int64_t signed_part(std::uint32_t value) const noexcept {
        return static_cast<std::int32_t>(value << shift_) >> shift_;
    }

    int shift_;
    bool started_ = false;
    std::int64_t total_ = 0;
};

/// Data of one read of an encoder's hardware.
struct EncoderReading {
    std::uint32_t counter = 0;  ///< counter of the hardware, modulo its width
    bool index_latched = false;
    std::uint32_t index_counter = 0;  ///< counter at the index, valid if isIndexLatched
};

/// Counts since the last reset or index.
class EncoderCount {
  public:
    explicit constexpr EncoderCount(int bits = 32) noexcept : counter_(bits) {}

    struct Request {
        bool isReset = false;
        bool isIndexEnabled = false;
    };
    struct Result {
        std::int64_t count = 0;    ///< since the last reset or index
        std::int64_t change = 0;   ///< since the last read; independent of reset and index
        std::int64_t raw = 0;      ///< since loading
        bool index_taken = false;  ///< the count was set to the index by this read
    };

    /// The reading at which the counter starts is count 0. A reset in the same read as an index has priority.
    constexpr Result read(const EncoderReading &reading, Request request) noexcept {
        const bool first = !counter_.hasStarted();
        const std::int64_t before = counter_.total();
        const std::int64_t total = counter_.follow(reading.counter);
        if (first) {
            start_ = zero_ = total;
        }
        Result result{0, first ? 0 : total - before, total - start_,
                      request.isIndexEnabled && reading.index_latched};
        if (result.index_taken) {
            zero_ = counter_.near(reading.index_counter);
        }
        if (request.isReset) {
            zero_ = total;
        }
        result.count = total - zero_;
        return result;
    }

  private:
    CounterExtension counter_;
    std::int64_t zero_ = 0;
    std::int64_t start_ = 0;
};

/// `count` modulo 2^32, for pins of type s32.
constexpr std::int32_t shown_count(std::int64_t count) noexcept {
    return static_cast<std::int32_t>(static_cast<std::uint32_t>(static_cast<std::uint64_t>(count)));
}

/// The nearest code for `wanted` [V], within a signed 32-bit register.
constexpr std::int32_t converter_code(double wanted, const ConverterRange &range) noexcept {
    constexpr double MOST = 2147483647.0;
    const double code = (wanted - range.hw_offset) / usable_scale(range.bit_weight);
    if (!isFinite(code)) {
        return 0;
    }
    const double within = code > MOST ? MOST : (code < -MOST ? -MOST : code);
    return static_cast<std::int32_t>(within < 0.0 ? within - 0.5 : within + 0.5);
}

/// The reading [V] of a converter's code.
constexpr double converter_reading(std::int32_t code, const ConverterRange &range) noexcept {
    return static_cast<double>(code) * usable_scale(range.bit_weight) - range.hw_offset;
}

}  // namespace mw::sdk

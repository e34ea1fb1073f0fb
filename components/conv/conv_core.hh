// SPDX-License-Identifier: GPL-2.0-or-later
// Converts values between HAL types: bool, double and integers of 32 and 64 bits. Realtime-safe.
#pragma once

#include <cmath>
#include <cstdint>
#include <limits>
#include <type_traits>

namespace mw::conv {

/// A float whose size is below this counts as zero when it is converted to a bit.
constexpr double FALSE_BELOW = 1e-6;

/// True when some values of `From` do not fit into `To`. Any value fits into a float.
template <class From, class To>
constexpr bool canOverflow() noexcept {
    if constexpr (std::is_same_v<From, bool> || std::is_floating_point_v<To>) {
        return false;
    } else if constexpr (std::is_same_v<To, bool> || std::is_floating_point_v<From>) {
        return true;
    } else {
        const bool losesSign = std::is_signed_v<From> && std::is_unsigned_v<To>;
        return losesSign || std::numeric_limits<From>::digits > std::numeric_limits<To>::digits;
    }
}

/// The value, and whether the input was outside the range of `To`.
template <class To>
struct Converted {
    To value{};
    bool out_of_range = false;
};

/// The nearest value of an integer type. A float is first truncated towards zero; NaN becomes 0.
template <class To, class From>
Converted<To> clamped(From value) noexcept {
    using Limits = std::numeric_limits<To>;
    if constexpr (std::is_floating_point_v<From>) {
        // 2^digits is exact as a double, max() of 64 bits is not.
        const double above = std::ldexp(1.0, Limits::digits);
        const double whole = std::trunc(value);
        if (std::isnan(value)) {
            return {0, true};
        }
        if (whole >= above) {
            return {Limits::max(), true};
        }
        if (whole < static_cast<double>(Limits::min())) {
            return {Limits::min(), true};
        }
        return {static_cast<To>(whole), false};
    } else {
        if constexpr (std::is_signed_v<From>) {
            if constexpr (std::is_unsigned_v<To>) {
                if (value < 0) {
                    return {0, true};
                }
            } else if (static_cast<std::int64_t>(value) < static_cast<std::int64_t>(Limits::min())) {
                return {Limits::min(), true};
            }
            if (value < 0) {
                return {static_cast<To>(value), false};
            }
        }
        if (static_cast<std::uint64_t>(value) > static_cast<std::uint64_t>(Limits::max())) {
            return {Limits::max(), true};
        }
        return {static_cast<To>(value), false};
    }
}

/// `value` modulo 2^bits, the same as copying the low bits of an integer.
template <class To, class From>
To wrapped(From value) noexcept {
    if constexpr (std::is_floating_point_v<From>) {
        if (!std::isfinite(value)) {
            return 0;
        }
        constexpr double MODULUS = 18446744073709551616.0;  // 2^64
        const auto size = static_cast<std::uint64_t>(std::fmod(std::trunc(std::fabs(value)), MODULUS));
        return static_cast<To>(value < 0.0 ? 0U - size : size);
    } else {
        return static_cast<To>(value);
    }
}

/// Converts `value`; a value outside the range is clamped or wrapped.
template <class To, class From>
Converted<To> convert(From value, bool clamping) noexcept {
    if constexpr (std::is_same_v<From, bool> || std::is_floating_point_v<To>) {
        return {static_cast<To>(value), false};
    } else if constexpr (std::is_same_v<To, bool>) {
        if constexpr (std::is_floating_point_v<From>) {
            const bool is_negative = value < 0.0;
            return {std::fabs(value) > FALSE_BELOW && !(is_negative && clamping), is_negative || value > 1.0};
        } else {
            const bool is_below = value < From{0};
            return {value != 0 && !(is_below && clamping), is_below || value > From{1}};
        }
    } else {
        Converted<To> result = clamped<To>(value);
        if (result.out_of_range && !clamping) {
            result.value = wrapped<To>(value);
        }
        return result;
    }
}

}  // namespace mw::conv

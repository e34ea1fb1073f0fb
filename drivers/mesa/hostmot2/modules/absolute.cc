// SPDX-License-Identifier: GPL-2.0-or-later
#include "drivers/mesa/hostmot2/modules/absolute.hh"

#include <algorithm>

namespace mw::mesa {

namespace {

constexpr double HZ_PER_KHZ = 1e3;
constexpr std::uint32_t LAST_TIMER = 4;

/// A rate is clock * n / 2^bits; 0 would mean no clock.
std::uint32_t rate_of(double khz, unsigned bits, std::uint32_t clock_hz) noexcept {
    const double steps = static_cast<double>(std::uint64_t{1} << bits);
    const double wanted = khz * HZ_PER_KHZ * steps / std::max(clock_hz, 1U);
    return wanted >= 1.0 ? static_cast<std::uint32_t>(std::min(wanted, steps - 1.0)) : 1U;
}

}  // namespace

std::uint32_t transfer_start(std::uint32_t timer) noexcept {
    constexpr std::uint32_t BY_PROGRAM = 1U << 8U, BY_TIMER = 1U << 9U;
    return timer == 0 ? BY_PROGRAM : (std::min(timer, LAST_TIMER) << 12U) | BY_TIMER;
}

std::uint32_t ssi_control(double khz, int bits, std::uint32_t timer, const Clocks &clocks) noexcept {
    return (rate_of(khz, 16, clocks.low_hz) << 16U) | transfer_start(timer) |
           static_cast<std::uint32_t>(bits);
}

std::uint32_t biss_control(double khz, int bits, const Clocks &clocks) noexcept {
    constexpr double MOST_FILTER = 63.0, PARTS_OF_BIT = 4.0;
    const double filter = clocks.high_hz / std::max(khz * HZ_PER_KHZ * PARTS_OF_BIT, 1.0);
    return (rate_of(khz, 16, clocks.low_hz) << 16U) |
           (static_cast<std::uint32_t>(std::min(filter, MOST_FILTER)) << 10U) |
           static_cast<std::uint32_t>(bits);
}

std::uint32_t fanuc_control(double khz, std::uint32_t filter, const Clocks &clocks) noexcept {
    constexpr std::uint32_t LEAST_FILTER = 1, MOST_FILTER = 15;
    return rate_of(khz, 20, clocks.low_hz) | (std::clamp(filter, LEAST_FILTER, MOST_FILTER) << 28U);
}

std::uint32_t fanuc_bits(int bits, const Clocks &clocks) noexcept {
    constexpr double REQUEST_S = 8e-6, MOST_CLOCKS = 1023.0;
    const auto request = static_cast<std::uint32_t>(std::min(REQUEST_S * clocks.low_hz, MOST_CLOCKS));
    return (static_cast<std::uint32_t>(bits) << 24U) | (request << 14U);
}

}  // namespace mw::mesa

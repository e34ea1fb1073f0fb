// SPDX-License-Identifier: GPL-2.0-or-later
#include "drivers/mesa/hostmot2/modules/uart.hh"

#include <algorithm>

namespace mw::mesa {

std::uint32_t uart_rate(std::uint32_t bitrate, std::uint32_t clock_hz, int bits) noexcept {
    const std::uint64_t steps = std::uint64_t{1} << static_cast<unsigned>(bits);
    const std::uint64_t clock = std::max(clock_hz, 1U);
    return static_cast<std::uint32_t>(std::min((bitrate * steps + clock / 2) / clock, steps - 1));
}

void Uart::setup(const Settings &settings) noexcept {
    settings_ = settings;
    setup_due_ = true;
}

std::size_t Uart::send(std::span<const std::uint8_t> bytes) noexcept {
    return queued_.push(bytes) ? bytes.size() : 0;
}

bool Uart::take_settings(Settings &settings) noexcept {
    const bool due = setup_due_;
    if (due) {
        settings = settings_;
        setup_due_ = false;
    }
    return due;
}

std::size_t Uart::wanted(std::size_t available) const noexcept {
    constexpr std::size_t BYTES_PER_SLOT = 4;
    return std::min({available, received_.space(), UART_RX_SLOTS * BYTES_PER_SLOT});
}

}  // namespace mw::mesa

// SPDX-License-Identifier: GPL-2.0-or-later
#include "drivers/mesa/hostmot2/modules/buffered_spi.hh"

#include <algorithm>
#include <cmath>

namespace mw::mesa {

namespace {

bool isChannel(int channel) noexcept {
    return channel >= 0 && channel < static_cast<int>(SPI_CHANNELS);
}

std::uint32_t flag(bool set, unsigned bit) noexcept {
    return set ? 1U << bit : 0U;
}

}  // namespace

std::uint32_t spi_descriptor(const SpiChannel &channel, std::uint32_t clock_hz) noexcept {
    constexpr double MOST_DIVIDER = 255.0, HZ_PER_MHZ = 1e6, NS_PER_S = 1e9;
    constexpr unsigned CPOL = 6, CPHA = 7, DIVIDER = 8, CHIP_SELECT = 16, DELAY = 24, LATE = 29, KEEP = 30,
                       NO_ECHO = 31;
    constexpr std::uint32_t NO_DELAY = 16, MOST_BITS = 32;
    // clock / (2 (n + 1)) is the bit rate.
    const double hz = std::max(channel.mhz * HZ_PER_MHZ, 1.0);
    const double divider = std::clamp(std::ceil(clock_hz / (2.0 * hz) - 1.0), 0.0, MOST_DIVIDER);
    const double clocks = std::ceil(channel.delay_ns * static_cast<double>(clock_hz) / NS_PER_S) - 1.0;
    const std::uint32_t delay =
        channel.delay_ns <= 0 ? NO_DELAY : static_cast<std::uint32_t>(std::clamp(clocks, 0.0, 15.0));
    const auto bits = std::clamp(static_cast<std::uint32_t>(std::max(channel.bits, 1)), 1U, MOST_BITS);
    return (bits - 1) | flag(channel.clock_high_idle, CPOL) | flag(channel.is_second_edge, CPHA) |
           (static_cast<std::uint32_t>(divider) << DIVIDER) |
           ((static_cast<std::uint32_t>(channel.chip_select) & 0xFU) << CHIP_SELECT) | (delay << DELAY) |
           flag(channel.sampled_late, LATE) | flag(channel.frame_kept, KEEP) |
           flag(channel.echo_off, NO_ECHO);
}

bool BufferedSpi::setup_channel(int channel, const SpiChannel &settings) noexcept {
    if (!isChannel(channel)) {
        return false;
    }
    channels_[static_cast<std::size_t>(channel)] = settings;
    setup_due_ = true;
    return true;
}

bool BufferedSpi::write(int channel, std::uint32_t value) noexcept {
    if (!isChannel(channel) || word_count_ == words_.size()) {
        return false;
    }
    words_[word_count_++] = {channel, value};
    return true;
}

BufferedSpi::Frame BufferedSpi::add_frame(int channel) noexcept {
    if (!isChannel(channel) || frame_count_ == frames_.size()) {
        return {};
    }
    frames_[frame_count_] = {channel, &sent_[frame_count_], &received_[frame_count_]};
    return frames_[frame_count_++];
}

bool BufferedSpi::take_setup() noexcept {
    const bool due = setup_due_;
    setup_due_ = false;
    return due;
}

std::span<const BufferedSpi::Word> BufferedSpi::take_words() noexcept {
    const std::size_t count = word_count_;
    word_count_ = 0;
    return {words_.data(), count};
}

}  // namespace mw::mesa

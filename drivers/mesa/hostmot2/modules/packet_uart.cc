// SPDX-License-Identifier: GPL-2.0-or-later
#include "drivers/mesa/hostmot2/modules/packet_uart.hh"

#include <algorithm>

namespace mw::mesa {

namespace {

constexpr std::size_t SIZE_BYTES = 2;  // before each frame in the queue

}  // namespace

void PacketUart::setup(const Settings &settings) noexcept {
    settings_ = settings;
    setup_due_ = true;
}

bool PacketUart::take_settings(Settings &settings) noexcept {
    const bool due = setup_due_;
    if (due) {
        settings = settings_;
        setup_due_ = false;
    }
    return due;
}

void PacketUart::reset() noexcept {
    queued_.clear();
    received_.clear();
    frames_ = size_ = missing_ = 0;
    reset_due_ = true;
}

bool PacketUart::take_reset() noexcept {
    const bool due = reset_due_;
    reset_due_ = false;
    return due;
}

bool PacketUart::send(std::span<const std::uint8_t> frame) noexcept {
    const bool usable = !frame.empty() && frame.size() <= MAX_FRAME_BYTES;
    if (!usable || queued_.space() < frame.size() + SIZE_BYTES) {
        return false;
    }
    const auto size = bytes_of(static_cast<std::uint32_t>(frame.size()));
    return queued_.push(std::span(size).first(SIZE_BYTES)) && queued_.push(frame);
}

std::size_t PacketUart::next_frame(std::span<std::uint8_t> bytes) noexcept {
    std::array<std::uint8_t, SIZE_BYTES> size{};
    if (queued_.pop(size) == 0) {
        return 0;
    }
    return queued_.pop(bytes.first(std::min<std::size_t>(word_of(size), bytes.size())));
}

std::size_t PacketUart::receive(std::span<std::uint8_t> bytes) noexcept {
    if (frames_ == 0) {
        return 0;
    }
    const std::size_t count = received_.pop(bytes.first(std::min<std::size_t>(bytes.size(), sizes_[0])));
    sizes_[0] = static_cast<std::uint16_t>(sizes_[0] - count);
    if (sizes_[0] == 0) {
        std::copy(sizes_.begin() + 1, sizes_.end(), sizes_.begin());
        --frames_;
    }
    return count;
}

std::uint32_t PacketUart::rx_status() const noexcept {
    using namespace packet_uart_bit;
    constexpr unsigned FRAMES_SHIFT = 16;
    const std::uint32_t others = rx_mode_ & ~(FRAMES | HAS_DATA);
    return others | (static_cast<std::uint32_t>(frames_) << FRAMES_SHIFT) | (frames_ > 0 ? HAS_DATA : 0U);
}

void PacketUart::show_modes(std::uint32_t tx_mode, std::uint32_t rx_mode) noexcept {
    tx_mode_ = tx_mode;
    rx_mode_ = rx_mode;
}

bool PacketUart::hasSpace() const noexcept {
    return frames_ < MAX_FRAMES && received_.space() >= MAX_FRAME_BYTES;
}

void PacketUart::begin_frame(std::size_t size) noexcept {
    size_ = 0;
    missing_ = std::min(size, MAX_FRAME_BYTES);
}

void PacketUart::take(std::span<const std::uint8_t> bytes) noexcept {
    const std::size_t count = std::min(bytes.size(), missing_);
    std::copy_n(bytes.begin(), count, frame_.begin() + static_cast<std::ptrdiff_t>(size_));
    size_ += count;
    missing_ -= count;
    if (missing_ == 0 && size_ > 0 && received_.push(std::span(frame_).first(size_))) {
        sizes_[frames_++] = static_cast<std::uint16_t>(size_);
        size_ = 0;
    }
}

void PacketUart::drop_frame() noexcept {
    size_ = missing_ = 0;
    ++failures_;
}

}  // namespace mw::mesa

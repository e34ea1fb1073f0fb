// SPDX-License-Identifier: GPL-2.0-or-later
// A serial line from a transmitter to a receiver of the same board. A test may connect a peer to it instead.
#pragma once

#include <deque>
#include <functional>
#include <optional>
#include <vector>

#include "drivers/mesa/board/clock.hh"

namespace mw::mesa::board {

using SerialBytes = std::vector<std::uint8_t>;

/// Bits per second of a bit rate register: ClockLow * n / 2^20.
constexpr std::int64_t bits_per_s(std::uint32_t rate, std::uint32_t clock_hz) {
    return multiply_divide(rate, clock_hz, std::int64_t{1} << 20U);
}

/// One line. A frame arrives when its last bit has been sent: 10 bits for each byte. [one thread]
class SerialLine {
  public:
    /// Answer of a peer to a frame; without a peer, the line is a loop.
    using Peer = std::function<std::optional<SerialBytes>(const SerialBytes &frame)>;
    void connect(Peer peer) { peer_ = std::move(peer); }

    /// Sends a frame after the pending ones. A bit rate of 0 sends nothing.
    void send(const SerialBytes &frame, std::int64_t now_ns, std::int64_t bits_per_s) {
        if (bits_per_s <= 0) {
            return;
        }
        const auto bits = static_cast<std::int64_t>(frame.size()) * BITS_IN_BYTE;
        sent_ns_ = (sent_ns_ > now_ns ? sent_ns_ : now_ns) + bits * NS_IN_S / bits_per_s;
        const auto answer = peer_ ? peer_(frame) : std::optional(frame);
        if (answer.has_value() && arrivals_.size() < MOST_FRAMES) {
            arrivals_.push_back({sent_ns_, *answer});
        }
        (void)pending(now_ns);
        sending_.push_back(sent_ns_);
    }
    /// The frames that are not yet sent.
    unsigned pending(std::int64_t now_ns) {
        while (!sending_.empty() && sending_.front() <= now_ns) {
            sending_.pop_front();
        }
        return static_cast<unsigned>(sending_.size());
    }
    /// The next frame that has arrived.
    std::optional<SerialBytes> receive(std::int64_t now_ns) {
        if (arrivals_.empty() || arrivals_.front().time_ns > now_ns) {
            return {};
        }
        SerialBytes bytes = std::move(arrivals_.front().bytes);
        arrivals_.pop_front();
        return bytes;
    }

  private:
    static constexpr std::int64_t BITS_IN_BYTE = 10;
    /// Frames that the host does not read; further ones are lost.
    static constexpr std::size_t MOST_FRAMES = 4096;
    struct Arrival {
        std::int64_t time_ns = 0;
        SerialBytes bytes;
    };
    std::deque<Arrival> arrivals_;
    std::deque<std::int64_t> sending_;
    std::int64_t sent_ns_ = 0;
    Peer peer_;
};

/// The lines of all instances of a type of UART.
using SerialLines = std::vector<SerialLine>;

}  // namespace mw::mesa::board

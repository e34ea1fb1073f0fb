// SPDX-License-Identifier: GPL-2.0-or-later
#include "drivers/mesa/board/board_transport.hh"

#include <algorithm>
#include <cerrno>

namespace mw::mesa::board {

lbp16::TransportResult BoardTransport::send(std::span<const std::byte> packet) noexcept {
    link_.send({packet.begin(), packet.end()}, now_ns_);
    return {.bytes = packet.size(), .time_ns = now_ns_};
}

lbp16::TransportResult BoardTransport::receive(std::span<std::byte> packet) noexcept {
    const auto reply = link_.receive(now_ns_);
    if (!reply.has_value()) {
        return {.error = EAGAIN, .time_ns = now_ns_};
    }
    const std::size_t size = std::min(packet.size(), reply->bytes.size());
    std::copy_n(reply->bytes.begin(), size, packet.begin());
    return {.bytes = size, .time_ns = now_ns_};
}

void BoardTransport::wait_until(std::int64_t deadline_ns) noexcept {
    if (deadline_ns <= now_ns_) {
        return;
    }
    // A reply that has arrived already needs no time.
    const std::int64_t next_ns = std::max(link_.next_ns().value_or(deadline_ns), now_ns_);
    now_ns_ = std::min(deadline_ns, next_ns);
    link_.run_until(now_ns_);
}

void BoardTransport::sleep_until(std::int64_t time_ns) {
    now_ns_ = std::max(now_ns_, time_ns);
    link_.run_until(now_ns_);
}

}  // namespace mw::mesa::board

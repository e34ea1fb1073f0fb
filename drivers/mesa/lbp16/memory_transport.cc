// SPDX-License-Identifier: GPL-2.0-or-later
#include "drivers/mesa/lbp16/memory_transport.hh"

#include <algorithm>
#include <cerrno>

namespace mw::mesa::lbp16 {

MemoryTransport::MemoryTransport() {
    for (auto &space : spaces_) {
        space.resize(SPACE_BYTES);
    }
}

TransportResult MemoryTransport::send(std::span<const std::byte> packet) noexcept {
    const Passage passage = to_board ? to_board(sent_) : Passage{};
    ++sent_;
    if (passage.error != 0) {
        return {.error = passage.error, .time_ns = now_ns_};
    }
    enter(to_board_, packet, now_ns_, passage);
    return {.bytes = packet.size(), .time_ns = now_ns_};
}

TransportResult MemoryTransport::receive(std::span<std::byte> packet) noexcept {
    deliver();
    if (from_board_.empty() || from_board_.front().at_ns > now_ns_) {
        return {.error = EAGAIN, .time_ns = now_ns_};
    }
    const auto bytes = std::move(from_board_.front().bytes);
    from_board_.pop_front();
    const std::size_t size = std::min(bytes.size(), packet.size());
    std::copy_n(bytes.begin(), size, packet.begin());
    return {.bytes = size, .time_ns = now_ns_};
}

void MemoryTransport::wait_until(std::int64_t deadline_ns) noexcept {
    deliver();
    const bool arrives = !from_board_.empty() && from_board_.front().at_ns <= deadline_ns;
    now_ns_ = std::max(now_ns_, arrives ? from_board_.front().at_ns : deadline_ns);
}

void MemoryTransport::advance(std::int64_t duration_ns) noexcept {
    now_ns_ += duration_ns;
}

std::uint32_t MemoryTransport::register_at(std::uint16_t address) const {
    return number_at<std::uint32_t>(std::span(spaces_[0]).subspan(address, 4));
}

void MemoryTransport::set_register(std::uint16_t address, std::uint32_t value) {
    std::ranges::copy(bytes_of_number(value), spaces_[0].begin() + address);
}

void MemoryTransport::set_words(Space space, std::uint16_t address, std::span<const std::uint16_t> words) {
    for (const std::uint16_t word : words) {
        std::ranges::copy(bytes_of_number(word), spaces_[static_cast<std::size_t>(space)].begin() + address);
        address = static_cast<std::uint16_t>(address + 2);
    }
}

/// Lets the board execute all packets that have reached it.
void MemoryTransport::deliver() {
    // Later packets are executed when the host reads again, because no answer can arrive before them.
    while (!to_board_.empty()) {
        const Packet packet = std::move(to_board_.front());
        to_board_.pop_front();
        execute(packet.bytes, packet.at_ns);
    }
}

void MemoryTransport::execute(std::span<const std::byte> packet, std::int64_t at_ns) {
    ++requests;
    std::vector<std::byte> answer;
    PacketReader reader(packet);
    while (!reader.isAtEnd()) {
        const auto received = reader.next();
        if (!received) {
            break;
        }
        const Command &command = received->command;
        auto &space = spaces_[static_cast<std::size_t>(command.space)];
        const std::size_t size = bytes_of(command.unit);
        for (std::size_t i = 0; i < command.units; ++i) {
            const std::size_t address = command.address + (command.incrementing ? i * size : 0);
            if (address + size > space.size()) {
                return;
            }
            const auto place = space.begin() + static_cast<std::ptrdiff_t>(address);
            if (!command.writes) {
                answer.insert(answer.end(), place, place + static_cast<std::ptrdiff_t>(size));
                continue;
            }
            std::ranges::copy(received->data.subspan(i * size, size), place);
            if (command.space == Space::HOSTMOT2) {
                written.push_back(
                    {static_cast<std::uint16_t>(address), register_at(static_cast<std::uint16_t>(address))});
            }
        }
    }
    if (!answer.empty()) {
        enter(from_board_, answer, at_ns, from_board ? from_board(answered_) : Passage{});
        ++answered_;
    }
}

void MemoryTransport::enter(std::deque<Packet> &way, std::span<const std::byte> packet, std::int64_t at_ns,
                            const Passage &passage) {
    const auto size = std::min(packet.size(), passage.cut_to);
    const std::vector<std::byte> bytes(packet.begin(), packet.begin() + static_cast<std::ptrdiff_t>(size));
    for (int copy = 0; copy < passage.copies; ++copy) {
        way.push_back({.at_ns = at_ns + WAY_NS + passage.delay_ns, .bytes = bytes});
    }
    std::ranges::stable_sort(way, {}, &Packet::at_ns);
}

}  // namespace mw::mesa::lbp16

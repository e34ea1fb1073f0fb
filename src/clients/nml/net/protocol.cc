// SPDX-License-Identifier: GPL-2.0-or-later
#include "clients/nml/net/protocol.hh"

#include <fmt/format.h>

namespace mw::nml {
namespace {

constexpr std::string_view MARK = "MWN";
constexpr char VERSION = 1;

void put(std::string &wire, std::uint64_t value, unsigned width) {
    for (unsigned i = width; i > 0; --i) {
        wire += static_cast<char>(value >> (8 * (i - 1)));
    }
}

std::uint64_t get(std::string_view wire, std::size_t at, unsigned width) {
    std::uint64_t value = 0;
    for (unsigned i = 0; i < width; ++i) {
        value = value << 8U | static_cast<unsigned char>(wire[at + i]);
    }
    return value;
}

}  // namespace

std::string to_wire(const Packet &packet) {
    std::string wire(MARK);
    wire += VERSION;
    put(wire, static_cast<std::uint8_t>(packet.operation), 1);
    put(wire, static_cast<std::uint8_t>(packet.status), 1);
    put(wire, 0, 2);
    put(wire, packet.buffer, 4);
    put(wire, packet.request, 4);
    put(wire, packet.number, 8);
    put(wire, static_cast<std::uint32_t>(packet.time_ms), 4);
    put(wire, packet.bytes.size(), 4);
    return wire += packet.bytes;
}

Result<Packet> read_packet_head(std::string_view head, std::size_t &size) {
    if (head.size() < PACKET_HEAD || !head.starts_with(MARK)) {
        return fail("these bytes are no message of Millwright's NML");
    }
    if (head[MARK.size()] != VERSION) {
        return fail(fmt::format("the other side has version {} of this protocol, this one has {}",
                                static_cast<int>(head[MARK.size()]), static_cast<int>(VERSION)));
    }
    const std::uint64_t operation = get(head, 4, 1), status = get(head, 5, 1);
    size = get(head, 28, 4);
    if (operation < static_cast<std::uint8_t>(Operation::LOGIN) ||
        operation > static_cast<std::uint8_t>(Operation::CLEAR) ||
        status > static_cast<std::uint8_t>(Status::REFUSED) || get(head, 6, 2) != 0) {
        return fail("there is no such operation");
    }
    if (size > MAX_PACKET_BYTES) {
        return fail(fmt::format("{} bytes are more than a message may have", size));
    }
    Packet packet;
    packet.operation = static_cast<Operation>(operation);
    packet.status = static_cast<Status>(status);
    packet.buffer = static_cast<std::uint32_t>(get(head, 8, 4));
    packet.request = static_cast<std::uint32_t>(get(head, 12, 4));
    packet.number = get(head, 16, 8);
    packet.time_ms = static_cast<std::int32_t>(get(head, 24, 4));
    return packet;
}

}  // namespace mw::nml

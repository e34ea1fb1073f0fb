// SPDX-License-Identifier: GPL-2.0-or-later
// Protocol between a buffer's server and its clients: a head of 32 bytes, big endian, then bytes.
//
//   'M' 'W' 'N' version(1)   operation(1) status(1) 0 0   buffer#(4)   request(4)
//   number(8)   time in milliseconds(4)   number of bytes after the head(4)
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>

#include "base/result.hh"

namespace mw::nml {

enum class Operation : std::uint8_t {
    LOGIN = 1,  ///< bytes: name, a zero byte, password
    WRITE = 2,  ///< the answer contains the number of the write
    READ = 3,   ///< number: of the last message read
    PEEK = 4,
    WAIT = 5,  ///< as READ; answered when there is a message, or after the time limit
    CLEAR = 6,
};

enum class Status : std::uint8_t {
    REQUEST = 0,
    DONE = 1,
    NOTHING = 2,  ///< there is no message
    REFUSED = 3,  ///< bytes: the reason
};

struct Packet {
    Operation operation = Operation::PEEK;
    Status status = Status::REQUEST;
    std::uint32_t buffer = 0;
    std::uint32_t request = 0;  ///< an answer has the number of its request
    std::uint64_t number = 0;
    std::int32_t time_ms = 0;  ///< maximum wait of the access; below 0: no limit
    std::string bytes;
};

inline constexpr std::size_t PACKET_HEAD = 32;
inline constexpr std::size_t MAX_PACKET_BYTES = 64UL << 20U;
using PacketHead = std::array<char, PACKET_HEAD>;

/// Head and bytes as sent.
std::string to_wire(const Packet &packet);

/// Reads the head; `size` bytes follow it. An error if it is not a head of this version.
Result<Packet> read_packet_head(std::string_view head, std::size_t &size);

}  // namespace mw::nml

// SPDX-License-Identifier: GPL-2.0-or-later
// The numbers by which host and board agree on packets: space 4 of the board has eight words that its host
// may use.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "drivers/mesa/lbp16/packet.hh"

namespace mw::mesa {

/// Words 0 and 1: the number of the last request; then two words for each packet of a write.
class HostNumbers {
  public:
    static constexpr std::uint16_t ADDRESS = 0x10;
    /// Packets into which one write may be divided.
    static constexpr std::size_t MAX_WRITE_PACKETS = 3;
    /// Bytes that append_to_request() adds to an answer.
    static constexpr std::size_t ANSWER_BYTES = 4 + 4 * MAX_WRITE_PACKETS;
    /// Bytes that append_to_write() adds to a packet.
    static constexpr std::size_t WRITE_BYTES = 8;

    /// Makes a request store its number and return all numbers. It is the last command of the request.
    static bool append_to_request(lbp16::PacketWriter &packet) noexcept {
        return append_number(packet, 0, 0) && packet.read({.space = lbp16::Space::TIMERS,
                                                           .unit = lbp16::Unit::BITS_16,
                                                           .units = ANSWER_BYTES / 2,
                                                           .address = ADDRESS});
    }
    /// Gives the request the next number.
    void number(lbp16::PacketWriter &request) noexcept {
        ++request_;
        constexpr std::size_t NUMBER_AND_READ = 4 + 4;
        request.replace(request.bytes().size() - NUMBER_AND_READ, lbp16::bytes_of_number(request_));
    }
    /// Makes packet `slot` of a write store the next number.
    bool append_to_write(lbp16::PacketWriter &packet, std::size_t slot) noexcept {
        writes_[slot] = ++write_;
        return append_number(packet, static_cast<std::uint16_t>(4 + 4 * slot), writes_[slot]);
    }

    /// The last ANSWER_BYTES of an answer belong to the last request.
    bool isOfLastRequest(std::span<const std::byte> numbers) const noexcept {
        return lbp16::number_at<std::uint32_t>(numbers) == request_;
    }
    /// The board has all packets of the writes.
    bool hasAllWrites(std::span<const std::byte> numbers) const noexcept {
        for (std::size_t slot = 0; slot < MAX_WRITE_PACKETS; ++slot) {
            if (lbp16::number_at<std::uint32_t>(numbers.subspan(4 + 4 * slot)) != writes_[slot]) {
                return false;
            }
        }
        return true;
    }
    /// Expects the numbers of the board, for example after it was switched on again.
    void accept(std::span<const std::byte> numbers) noexcept {
        for (std::size_t slot = 0; slot < MAX_WRITE_PACKETS; ++slot) {
            writes_[slot] = lbp16::number_at<std::uint32_t>(numbers.subspan(4 + 4 * slot));
        }
    }
    std::uint32_t last_request() const noexcept { return request_; }

  private:
    static bool append_number(lbp16::PacketWriter &packet, std::uint16_t offset,
                              std::uint32_t number) noexcept {
        return packet.write({.writes = true,
                             .space = lbp16::Space::TIMERS,
                             .unit = lbp16::Unit::BITS_16,
                             .units = 2,
                             .address = static_cast<std::uint16_t>(ADDRESS + offset)},
                            lbp16::bytes_of_number(number));
    }

    std::uint32_t request_ = 0, write_ = 0;
    std::array<std::uint32_t, MAX_WRITE_PACKETS> writes_{};
};

}  // namespace mw::mesa

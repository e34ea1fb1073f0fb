// SPDX-License-Identifier: GPL-2.0-or-later
// The numbers by which host and board identify packets: space 4 of the board has eight words for its host.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <utility>

#include "drivers/mesa/lbp16/packet.hh"

namespace mw::mesa {

/// Words 0 and 1: the number of the last request. Words 2 and 3, 4, 5: the number of the last write in its
/// first, second, third packet. Words 6 and 7: a mark that a board loses when it restarts. A request stores
/// the mark, after its reads, only if the last answer has shown that it is missing. So no packet hides a
/// restart.
class HostNumbers {
  public:
    static constexpr std::uint16_t ADDRESS = 0x10;
    /// Maximum number of packets of one write.
    static constexpr std::size_t MAX_WRITE_PACKETS = 3;
    /// Bytes that append_to_request() adds to an answer.
    static constexpr std::size_t ANSWER_BYTES = 16;
    /// Bytes that append_to_write() adds to a packet.
    static constexpr std::size_t WRITE_BYTES = 8;

    /// Makes a request store its number and return all numbers. These are the last commands of the request.
    static bool append_to_request(lbp16::PacketWriter &packet) noexcept {
        return append(packet, 0, lbp16::bytes_of_number(std::uint32_t{0})) &&
               packet.read({.space = lbp16::Space::TIMERS,
                            .unit = lbp16::Unit::BITS_16,
                            .units = ANSWER_BYTES / 2,
                            .address = ADDRESS}) &&
               append(packet, MARK_OFFSET, lbp16::bytes_of_number(MARK));
    }
    /// Sets the next number in the request; returns the bytes to send.
    std::span<const std::byte> number(lbp16::PacketWriter &request) noexcept {
        ++request_;
        constexpr std::size_t NUMBER_AND_READ = 4 + 4, MARK_COMMAND = 8;
        const std::size_t size = request.bytes().size() - MARK_COMMAND;
        request.replace(size - NUMBER_AND_READ, lbp16::bytes_of_number(request_));
        return std::exchange(mark_due_, false) ? request.bytes() : request.bytes().first(size);
    }
    /// Makes packet `slot` of a write store the next number.
    bool append_to_write(lbp16::PacketWriter &packet, std::size_t slot) noexcept {
        ++writes_[slot];
        return slot == 0 ? append(packet, offset_of(slot), lbp16::bytes_of_number(writes_[slot]))
                         : append(packet, offset_of(slot), lbp16::bytes_of_number(low_half(writes_[slot])));
    }

    /// True if the last ANSWER_BYTES of an answer belong to the last request.
    bool isOfLastRequest(std::span<const std::byte> numbers) const noexcept {
        return lbp16::number_at<std::uint32_t>(numbers) == request_;
    }
    /// True once after the board has lost its memory. `numbers` belong to the last request.
    bool take_restart(std::span<const std::byte> numbers) noexcept {
        const bool marked = lbp16::number_at<std::uint32_t>(numbers.subspan(MARK_OFFSET)) == MARK;
        const bool restarted = marked_ && !marked;
        marked_ = marked;
        mark_due_ = !marked;
        return restarted;
    }
    /// True if the board has received all packets of the writes.
    bool hasAllWrites(std::span<const std::byte> numbers) const noexcept {
        bool all = lbp16::number_at<std::uint32_t>(numbers.subspan(offset_of(0))) == writes_[0];
        for (std::size_t slot = 1; slot < MAX_WRITE_PACKETS; ++slot) {
            all = all && lbp16::number_at<std::uint16_t>(numbers.subspan(offset_of(slot))) ==
                             low_half(writes_[slot]);
        }
        return all;
    }
    /// Expects the numbers of the board from now on, for example after it was switched on again.
    void accept(std::span<const std::byte> numbers) noexcept {
        writes_[0] = lbp16::number_at<std::uint32_t>(numbers.subspan(offset_of(0)));
        for (std::size_t slot = 1; slot < MAX_WRITE_PACKETS; ++slot) {
            writes_[slot] = lbp16::number_at<std::uint16_t>(numbers.subspan(offset_of(slot)));
        }
    }
    std::uint32_t last_request() const noexcept { return request_; }

  private:
    static constexpr std::uint32_t MARK = 0x4D4B574D;
    static constexpr std::size_t MARK_OFFSET = 12, WORD_BYTES = 2;

    static constexpr std::uint16_t low_half(std::uint32_t number) noexcept {
        return static_cast<std::uint16_t>(number);
    }
    static constexpr std::size_t offset_of(std::size_t slot) noexcept {
        constexpr std::size_t FIRST = 4, SECOND = 8;
        return slot == 0 ? FIRST : SECOND + WORD_BYTES * (slot - 1);
    }
    static bool append(lbp16::PacketWriter &packet, std::size_t offset,
                       std::span<const std::byte> number) noexcept {
        return packet.write({.writes = true,
                             .space = lbp16::Space::TIMERS,
                             .unit = lbp16::Unit::BITS_16,
                             .units = static_cast<std::uint8_t>(number.size() / WORD_BYTES),
                             .address = static_cast<std::uint16_t>(ADDRESS + offset)},
                            number);
    }

    std::uint32_t request_ = 0;
    std::array<std::uint32_t, MAX_WRITE_PACKETS> writes_{};
    bool marked_ = false;    ///< the last answer contained the mark
    bool mark_due_ = false;  ///< the answer to the last request did not contain the mark
};

}  // namespace mw::mesa

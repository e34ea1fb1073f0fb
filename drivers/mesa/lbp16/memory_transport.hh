// SPDX-License-Identifier: GPL-2.0-or-later
// A board without behaviour, for tests: its spaces are plain memory, time is virtual, and packets are lost,
// duplicated or delayed as set by the test.
#pragma once

#include <array>
#include <deque>
#include <functional>
#include <vector>

#include "drivers/mesa/lbp16/packet.hh"
#include "drivers/mesa/lbp16/transport.hh"

namespace mw::mesa::lbp16 {

/// Transfer of a packet through the network.
struct Passage {
    int copies = 1;             ///< 0: the packet is lost
    std::int64_t delay_ns = 0;  ///< added to `MemoryTransport::WAY_NS`
    std::size_t cut_to = MAX_PACKET_BYTES;
    int error = 0;  ///< errno of a send that fails
};

class MemoryTransport final : public Transport {
  public:
    static constexpr std::int64_t WAY_NS = 20'000;  ///< time in one direction
    static constexpr std::size_t SPACE_BYTES = 0x10000;

    MemoryTransport();

    TransportResult send(std::span<const std::byte> packet) noexcept override;
    TransportResult receive(std::span<std::byte> packet) noexcept override;
    void wait_until(std::int64_t deadline_ns) noexcept override;
    std::int64_t now_ns() const noexcept override { return now_ns_; }

    void advance(std::int64_t duration_ns) noexcept;
    std::uint32_t register_at(std::uint16_t address) const;
    void set_register(std::uint16_t address, std::uint32_t value);
    void set_words(Space space, std::uint16_t address, std::span<const std::uint16_t> words);
    /// Each written register of the space HOSTMOT2, in order.
    struct Written {
        std::uint16_t address;
        std::uint32_t value;
        bool operator==(const Written &) const = default;
    };

    std::vector<Written> written;
    std::size_t requests = 0;                        ///< packets that the board has received
    std::function<Passage(std::size_t)> to_board;    ///< for the packet number, from 0; empty: no faults
    std::function<Passage(std::size_t)> from_board;  ///< for the answer number

  private:
    struct Packet {
        std::int64_t at_ns;
        std::vector<std::byte> bytes;
    };

    void deliver();
    void execute(std::span<const std::byte> packet, std::int64_t at_ns);
    void enter(std::deque<Packet> &way, std::span<const std::byte> packet, std::int64_t at_ns,
               const Passage &passage);

    std::int64_t now_ns_ = 1'000'000'000;
    std::array<std::vector<std::byte>, 8> spaces_;
    std::deque<Packet> to_board_, from_board_;
    std::size_t sent_ = 0, answered_ = 0;
};

}  // namespace mw::mesa::lbp16

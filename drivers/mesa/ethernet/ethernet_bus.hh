// SPDX-License-Identifier: GPL-2.0-or-later
// The registers of a board on Ethernet: in each cycle one request, one answer and one write packet.
//
// The board stores words for its host (space 4). Each request and each write packet stores its number there,
// and each answer returns the numbers. So an answer shows to which request it belongs, and whether the last
// write arrived. Source: shared/hardware.md, part A3.
//
// After a fault there is no traffic until an operator resets it. Then the identity of the board is read and
// compared with the one read at loading, before anything is written.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "drivers/mesa/ethernet/cycle_ring.hh"
#include "drivers/mesa/ethernet/error_level.hh"
#include "drivers/mesa/ethernet/host_numbers.hh"
#include "drivers/mesa/hostmot2/register_bus.hh"
#include "drivers/mesa/identity/cards.hh"
#include "drivers/mesa/lbp16/packet.hh"
#include "drivers/mesa/lbp16/transport.hh"

namespace mw::mesa {

/// Numbers of failures by type.
struct EthernetCounters {
    std::uint32_t no_answer = 0, send_failed = 0, receive_failed = 0, short_answer = 0, write_lost = 0;
    std::uint32_t stale = 0;  ///< answers to older requests; not a failure
};

class EthernetBus final : public RegisterBus {
  public:
    /// Identifies the card that answers. `address` is for messages. [while loading]
    static Result<std::unique_ptr<EthernetBus>> open(std::unique_ptr<lbp16::Transport> transport,
                                                     std::string address);

    std::string card_name() const override;
    std::vector<std::string> connectors() const override;
    int port_width() const override;
    /// The name reported by the card, without trailing blanks.
    const std::string &reported_name() const { return reported_name_; }
    bool isKnownCard() const { return card_ != nullptr; }
    /// The MAC address of the board, the first byte first.
    std::array<std::uint8_t, 6> mac() const;

    Result<std::vector<std::uint32_t>> read_now(RegisterRange range) override;
    Result<> write_now(std::uint16_t address, std::span<const std::uint32_t> values) override;
    void pause_now(std::chrono::nanoseconds duration) override;
    Result<> set_lists(std::span<const RegisterRange> reads, int max_writes) override;

    void request() noexcept override;
    CycleRead read(std::span<std::uint32_t> values, long period_ns) noexcept override;
    /// Only for a range of one register.
    bool redirect(int range, std::uint16_t address) noexcept override;
    bool write(std::span<const RegisterWrite> writes) noexcept override;
    bool take_rewrite() noexcept override;
    bool isRestartVisible() const noexcept override { return true; }
    bool take_restart() noexcept override;

    /// May be changed between cycles. [servo thread]
    EthernetSettings settings;

    /// True if the last cycle has failed.
    bool isFailed() const noexcept { return failed_; }
    bool isStopped() const noexcept { return link_ == Link::STOPPED; }
    const ErrorLevel &errors() const noexcept { return errors_; }
    const EthernetCounters &counters() const noexcept { return counters_; }
    /// The last cycle; nullptr before the first one.
    const CycleTimes *last_cycle() const noexcept { return log_.isEmpty() ? nullptr : &log_.last(); }
    /// Writes the cycles to `record`, which must outlive the bus. [while loading]
    void record_cycles_in(CycleRecord &record) noexcept {
        log_ = CycleLog(record);
        own_record_.reset();
    }
    void note_watchdog_bite() noexcept override { log_.keep(BoardFault::WATCHDOG, transport_->now_ns()); }
    /// Stops all traffic, as too many failures do. [servo thread]
    void stop() noexcept;
    /// The operator has reset the fault: the board is compared and then served again. [servo thread]
    void resume() noexcept;

  private:
    /// State of the bus in a cycle.
    enum class Link : std::uint8_t {
        RUNNING,
        STOPPED,    ///< no traffic
        COMPARING,  ///< reads the identity
    };
    /// A request that is complete except for its number, and the size of its answer before the numbers. The
    /// last two bytes of the cyclic answer are the number of packets that the board has received.
    struct Request {
        lbp16::PacketWriter packet;
        std::size_t data_bytes = 0;
    };

    EthernetBus(std::unique_ptr<lbp16::Transport> transport, std::string address);

    Result<> identify();
    Result<std::vector<std::byte>> exchange(const lbp16::PacketWriter &packet, std::string_view what);
    CycleOutcome wait_for_answer(std::int64_t deadline_ns, CycleTimes &cycle) noexcept;
    CycleOutcome outcome_of_answer() noexcept;
    void count(CycleOutcome outcome) noexcept;
    const Request &current() const noexcept { return link_ == Link::COMPARING ? identity_ : cyclic_; }

    std::unique_ptr<lbp16::Transport> transport_;
    std::string address_;
    std::string reported_name_;
    const Card *card_ = nullptr;  ///< nullptr: not in the table

    Request cyclic_, identity_;
    std::vector<std::size_t>
        single_offsets_;  ///< offset of the address of each range in the request; 0: several registers
    std::vector<std::byte> known_identity_;
    std::array<std::byte, lbp16::MAX_PACKET_BYTES> answer_{};

    Link link_ = Link::RUNNING;
    bool requested_ = false;
    bool failed_ = false;
    bool rewriting_ = false;
    bool restarted_ = false;
    HostNumbers numbers_;
    ErrorLevel errors_;
    EthernetCounters counters_;
    std::uint16_t host_packets_ = 0;
    std::unique_ptr<CycleRecord> own_record_ = std::make_unique<CycleRecord>();
    CycleLog log_{*own_record_};
};

}  // namespace mw::mesa

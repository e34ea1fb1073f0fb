// SPDX-License-Identifier: GPL-2.0-or-later
// The registers of a board on PCI, EPP or SPI, for the driver.
//
// These buses do not report whether a board answers: a board without power reads as all zeros or all ones. So
// each cycle also reads the cookie of the firmware, and fails if it is wrong. After too many failures in a
// row, or when io_error is set, there is no traffic until an operator resets the fault. Then the description
// of the firmware is compared with the one read at loading, a part in each cycle, before anything is written.
// Source: shared/hardware.md, part G.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "drivers/mesa/direct/register_access.hh"
#include "drivers/mesa/hostmot2/register_bus.hh"

namespace mw::mesa {

/// Data of a card that its bus knows.
struct DirectCard {
    std::string hal_name{};                 ///< 5i25
    std::vector<std::string> connectors{};  ///< one for each port; empty: as in the firmware
    int port_width = 0;                     ///< 0: as in the firmware
    int leds = 0;
    int most_failures = 1;  ///< consecutive failed cycles that stop the traffic
};

/// Reason why a cycle has failed.
enum class DirectFault : std::uint8_t {
    NONE,
    ACCESS,       ///< the bus reports an error
    NO_COOKIE,    ///< the values are not from the firmware
    OTHER_BOARD,  ///< after a reset by the operator: another board than at loading
};

class DirectBus final : public RegisterBus {
  public:
    /// Reads the identity of the board. `place` is for messages, such as "PCI 0000:01:00.0". [while loading]
    static Result<std::unique_ptr<DirectBus>> open(std::unique_ptr<RegisterAccess> access, DirectCard card,
                                                   std::string place);

    std::string card_name() const override { return card_.hal_name; }
    std::vector<std::string> connectors() const override { return card_.connectors; }
    int port_width() const override { return card_.port_width; }
    int leds() const override { return card_.leds; }

    Result<std::vector<std::uint32_t>> read_now(RegisterRange range) override;
    Result<> write_now(std::uint16_t address, std::span<const std::uint32_t> values) override;
    void pause_now(std::chrono::nanoseconds duration) override { access_->pause(duration); }
    Result<> set_lists(std::span<const RegisterRange> reads, int max_writes) override;

    /// The read of a cycle needs no request.
    void request() noexcept override {}
    CycleRead read(std::span<std::uint32_t> values, long period_ns) noexcept override;
    bool redirect(int range, std::uint16_t address) noexcept override;
    bool write(std::span<const RegisterWrite> writes) noexcept override;
    bool take_rewrite() noexcept override;
    bool hasImmediateAccess() const noexcept override { return access_->isImmediate(); }
    bool read_immediately(std::uint16_t address, std::span<std::uint32_t> values) noexcept override {
        return access_->read(address, values);
    }
    bool write_immediately(std::span<const RegisterWrite> writes) noexcept override {
        return access_->write_list(writes);
    }

    bool isFailed() const noexcept { return fault_ != DirectFault::NONE; }
    bool isStopped() const noexcept { return link_ == Link::STOPPED; }
    /// Fault of the last cycle.
    DirectFault fault() const noexcept { return fault_; }
    int last_error() const noexcept { return access_->last_error(); }
    /// The word that was read instead of the cookie.
    std::uint32_t cookie() const noexcept { return cookie_; }
    std::uint32_t failed_cycles() const noexcept { return failed_cycles_; }
    /// Stops all traffic. [servo thread]
    void stop() noexcept {
        link_ = Link::STOPPED;
        answered_ = false;
    }
    /// The operator has reset the fault: the board is compared and then served again. [servo thread]
    void resume() noexcept;

  private:
    enum class Link : std::uint8_t { RUNNING, STOPPED, COMPARING };

    DirectBus(std::unique_ptr<RegisterAccess> access, DirectCard card, std::string place)
        : access_(std::move(access)), card_(std::move(card)), place_(std::move(place)) {}
    Result<> identify();
    Error error_of(const std::string &what) const;
    DirectFault read_cycle(std::span<std::uint32_t> values) noexcept;
    DirectFault compare_some() noexcept;
    void count(DirectFault fault) noexcept;

    std::unique_ptr<RegisterAccess> access_;
    DirectCard card_;
    std::string place_;

    std::vector<RegisterRange> ranges_;  ///< the cookie, then the ranges of set_lists()
    std::vector<std::uint32_t> values_;  ///< values of all ranges
    std::uint16_t idrom_address_ = 0;
    std::vector<std::uint32_t> identity_;  ///< the description of the firmware
    std::size_t compared_ = 0;             ///< number of words compared so far

    Link link_ = Link::RUNNING;
    DirectFault fault_ = DirectFault::NONE;
    bool answered_ = false;  ///< the last read was successful, so a write may follow
    bool rewriting_ = false;
    int failures_ = 0;  ///< consecutive failures
    std::uint32_t failed_cycles_ = 0;
    std::uint32_t cookie_ = 0;
};

}  // namespace mw::mesa

// SPDX-License-Identifier: GPL-2.0-or-later
// The interface of the driver to the registers of a board. Each bus (Ethernet, PCI, SPI, EPP, a board in
// memory) is an implementation. While a component is loaded, registers are read and written one by one; the
// servo thread reads one list that was fixed before, and writes one list.
#pragma once

#include <chrono>
#include <cstdint>
#include <span>
#include <string>
#include <thread>
#include <vector>

#include "base/result.hh"

namespace mw::mesa {

/// `count` consecutive registers of 32 bit from `address` [bytes].
struct RegisterRange {
    std::uint16_t address = 0;
    std::uint16_t count = 1;

    bool operator==(const RegisterRange &) const = default;
};

/// One register and the value to write.
struct RegisterWrite {
    std::uint16_t address = 0;
    std::uint32_t value = 0;

    bool operator==(const RegisterWrite &) const = default;
};

/// Result of the read of a cycle.
enum class CycleRead : std::uint8_t {
    DONE,     ///< all values are from this cycle
    FAILED,   ///< no value is new; the bus has counted the failure
    STOPPED,  ///< too many failures: there is no traffic until an operator resets the fault
};

class RegisterBus {
  public:
    virtual ~RegisterBus() = default;

    /// The name of the card in HAL, such as "7i76e", and the names of the connectors, one for each port.
    virtual std::string card_name() const = 0;
    virtual std::vector<std::string> connectors() const = 0;
    /// Pins of each connector; 0: as in the firmware.
    virtual int port_width() const { return 0; }
    /// Lamps that the driver can switch: the pins CR01, CR02...
    virtual int leds() const { return 4; }

    /// Reads registers now. [while loading; an error names the board and what failed]
    virtual Result<std::vector<std::uint32_t>> read_now(RegisterRange range) = 0;
    /// Writes registers from `address` now. [while loading]
    virtual Result<> write_now(std::uint16_t address, std::span<const std::uint32_t> values) = 0;
    /// Waits while a processor of the board works. [while loading]
    virtual void pause_now(std::chrono::nanoseconds duration) { std::this_thread::sleep_for(duration); }
    /// Fixes the registers that each cycle reads, and the maximum number of registers that one cycle writes.
    /// An error if they do not fit into one cycle of the bus. [while loading]
    virtual Result<> set_lists(std::span<const RegisterRange> reads, int max_writes) = 0;

    /// Sends the request of this cycle, so that its answer arrives while other boards are read. Optional
    /// before read(). [servo thread]
    virtual void request() noexcept = 0;
    /// Reads the values of all ranges of set_lists(), in their order. `period_ns` of the thread limits the
    /// wait. [servo thread; does not block longer than the deadline]
    virtual CycleRead read(std::span<std::uint32_t> values, long period_ns) noexcept = 0;
    /// From the next request on reads another address as range number `range`, for raw access by a user;
    /// false if this bus cannot. [servo thread]
    virtual bool redirect(int range, std::uint16_t address) noexcept {
        (void)range;
        (void)address;
        return false;
    }
    /// Writes a list in its order; false if it could not be sent. [servo thread]
    virtual bool write(std::span<const RegisterWrite> writes) noexcept = 0;
    /// True if registers can be read and written at any time, also by a faster thread than that of the cycle,
    /// as on PCI. Both functions below may then be used in addition to the cycle. [while loading]
    virtual bool hasImmediateAccess() const noexcept { return false; }
    /// Reads `values.size()` registers from `address`; false: it failed. [any realtime thread]
    virtual bool read_immediately(std::uint16_t address, std::span<std::uint32_t> values) noexcept {
        (void)address;
        (void)values;
        return false;
    }
    /// Writes a list in its order; false: it failed. [any realtime thread]
    virtual bool write_immediately(std::span<const RegisterWrite> writes) noexcept {
        (void)writes;
        return false;
    }
    /// True once after a failure: the board may have missed writes, so the next write() must contain all
    /// registers. [servo thread]
    virtual bool take_rewrite() noexcept = 0;
    /// True if take_restart() detects each restart of the board. On other buses a restart has the same effect
    /// as a bite of the watchdog. [servo thread]
    virtual bool isRestartVisible() const noexcept { return false; }
    /// True once after the board has lost its registers, because it was without power or was reset. [servo
    /// thread]
    virtual bool take_restart() noexcept { return false; }
    /// Called when the watchdog of the board has bitten: a bus that records its cycles stores them. [servo
    /// thread]
    virtual void note_watchdog_bite() noexcept {}
};

}  // namespace mw::mesa

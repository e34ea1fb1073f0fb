// SPDX-License-Identifier: GPL-2.0-or-later
// Registers of a board that this computer accesses directly, without packets that may be late: PCI, EPP, SPI.
#pragma once

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdint>
#include <span>
#include <thread>

#include "drivers/mesa/hostmot2/register_bus.hh"

namespace mw::mesa {

/// Number of writes from the first one on that have consecutive addresses, at most `most`.
inline std::size_t consecutive_writes(std::span<const RegisterWrite> writes, std::size_t most) noexcept {
    std::size_t count = std::min<std::size_t>(writes.size(), 1);
    while (count < std::min(writes.size(), most) &&
           writes[count].address == static_cast<std::uint16_t>(writes[count - 1].address + 4)) {
        ++count;
    }
    return count;
}

/// Each access is complete when the call returns. After a failure the registers may or may not be written.
/// [while loading, and then the servo thread]
class RegisterAccess {
  public:
    virtual ~RegisterAccess() = default;

    /// Reads consecutive registers from `address`; false on failure.
    virtual bool read(std::uint16_t address, std::span<std::uint32_t> values) noexcept = 0;
    virtual bool write(std::uint16_t address, std::span<const std::uint32_t> values) noexcept = 0;

    /// Allocates the buffers for the reads and writes of a cycle. [while loading]
    virtual Result<> prepare(std::span<const RegisterRange> /*reads*/, int /*max_writes*/) { return {}; }
    /// Reads all ranges, in their order.
    virtual bool read_list(std::span<const RegisterRange> ranges, std::span<std::uint32_t> values) noexcept {
        for (const RegisterRange &range : ranges) {
            if (!read(range.address, values.first(range.count))) {
                return false;
            }
            values = values.subspan(range.count);
        }
        return true;
    }
    /// Writes all registers, in their order.
    virtual bool write_list(std::span<const RegisterWrite> writes) noexcept {
        constexpr std::size_t MAX_BLOCK = 32;
        while (!writes.empty()) {
            const std::size_t count = consecutive_writes(writes, MAX_BLOCK);
            std::array<std::uint32_t, MAX_BLOCK> values{};
            for (std::size_t i = 0; i < count; ++i) {
                values[i] = writes[i].value;
            }
            if (!write(writes[0].address, std::span(values).first(count))) {
                return false;
            }
            writes = writes.subspan(count);
        }
        return true;
    }
    /// Waits, in the time of the board. [while loading]
    virtual void pause(std::chrono::nanoseconds duration) { std::this_thread::sleep_for(duration); }
    /// True if another thread may use it at the same time, as on PCI.
    virtual bool isImmediate() const noexcept { return false; }
    /// The errno of the last failure; 0 if the access does not report errors.
    virtual int last_error() const noexcept { return 0; }
};

}  // namespace mw::mesa

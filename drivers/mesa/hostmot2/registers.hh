// SPDX-License-Identifier: GPL-2.0-or-later
// The registers that a cycle reads and writes. While loading, modules request their registers; then the lists
// are fixed. A cycle reads one list and writes one list: all registers after a failure, otherwise the
// registers that are written in each cycle and those whose value has changed.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "base/result.hh"
#include "drivers/mesa/hostmot2/register_bus.hh"

namespace mw::mesa {

/// The order in which registers are read. The board synchronises to the read of DPLL_SYNC. The count of time
/// stamps is read before the counters, so that no time stamp is in the future.
enum class ReadOrder : std::uint8_t {
    PORT,
    DPLL_SYNC,
    WATCHDOG,
    STEP_ACCUMULATOR,
    ENCODER_TIME,
    ENCODER_COUNT,
    ENCODER_CONTROL,
    SMART_SERIAL,
    INPUT,
    OTHER,
};

/// The order in which registers are written. A bite of the watchdog clears directions and open drains, so the
/// watchdog is cleared before them. Directions are last: a pin becomes an output when everything else is set.
enum class WriteOrder : std::uint8_t {
    WATCHDOG_SETUP,
    CONFIGURATION,
    PORT_DATA,
    WATCHDOG_RESET,
    RATE,
    SMART_SERIAL,
    PORT_INVERT,
    PORT_OPEN_DRAIN,
    PORT_SOURCE,
    PORT_DIRECTION,
};

/// Condition for writing a register.
enum class Send : std::uint8_t {
    ALWAYS,       ///< in each cycle
    CHANGED,      ///< when its value changed, and after a failure
    AFTER_FAULT,  ///< when all registers are written
    REQUESTED,    ///< only after request()
    REPEATED,     ///< after request(), and from then on when all registers are written
};

struct ReadHandle {
    int index = -1;
};
struct WriteHandle {
    int index = -1;
};

class Registers {
  public:
    /// Reads `range` in each cycle. [while loading]
    ReadHandle read(RegisterRange range, ReadOrder order);
    /// Writes a register; registers of one order are written in the order of these calls. [while loading]
    WriteHandle write(std::uint16_t address, WriteOrder order, Send send, std::uint32_t value = 0);
    /// Fixes the lists. An error of the bus explains why it cannot carry them. [while loading]
    Result<> fix(RegisterBus &bus);

    /// The words filled by a read. [servo thread]
    std::span<std::uint32_t> inputs() noexcept { return inputs_; }
    /// The word `i` of a range. [servo thread]
    std::uint32_t value(ReadHandle handle, int i = 0) const noexcept {
        return inputs_[static_cast<std::size_t>(reads_[static_cast<std::size_t>(handle.index)].first + i)];
    }
    /// Sets the value to be written. [servo thread]
    void set(WriteHandle handle, std::uint32_t value) noexcept {
        writes_[static_cast<std::size_t>(handle.index)].value = value;
    }
    /// Sets the value and writes it in this cycle. [servo thread]
    void request(WriteHandle handle, std::uint32_t value) noexcept {
        Write &write = writes_[static_cast<std::size_t>(handle.index)];
        write.value = value;
        write.requested = true;
        write.ever_requested = true;
    }
    /// A register with Send::REPEATED is not written again until the next request(). [servo thread]
    void forget(WriteHandle handle) noexcept {
        writes_[static_cast<std::size_t>(handle.index)].ever_requested = false;
    }
    /// Writes to another register from now on. [servo thread]
    void set_address(WriteHandle handle, std::uint16_t address) noexcept {
        writes_[static_cast<std::size_t>(handle.index)].address = address;
    }
    /// Reads another address; false if the bus cannot. [servo thread]
    bool redirect(ReadHandle handle, std::uint16_t address) noexcept;
    /// The list for this cycle, valid until the next call. Its values count as written. [servo thread]
    std::span<const RegisterWrite> list(bool all) noexcept;
    /// Register number `i` and its last written value; nothing if there are fewer registers. A register that
    /// was never written has the value 0. [any time between cycles]
    std::optional<RegisterWrite> written(int i) const noexcept {
        const auto n = static_cast<std::size_t>(i);
        return n < sequence_.size() ? std::optional<RegisterWrite>(
                                          {writes_[sequence_[n]].address, writes_[sequence_[n]].written})
                                    : std::nullopt;
    }
    /// As list(), for the case that all registers are written; for tests and messages.
    const std::vector<RegisterRange> &ranges() const noexcept { return ranges_; }

  private:
    struct Read {
        RegisterRange range;
        ReadOrder order = ReadOrder::OTHER;
        int first = 0;     ///< index of its first word
        int position = 0;  ///< in ranges_
    };
    struct Write {
        std::uint16_t address = 0;
        WriteOrder order = WriteOrder::CONFIGURATION;
        Send send = Send::CHANGED;
        std::uint32_t value = 0, written = 0;
        bool is_written = false, requested = false, ever_requested = false;
    };
    static bool isDue(const Write &write, bool all) noexcept;

    RegisterBus *bus_ = nullptr;
    std::vector<Read> reads_;
    std::vector<Write> writes_;
    std::vector<std::uint16_t> sequence_;  ///< indices of writes_ in their order
    std::vector<RegisterRange> ranges_;
    std::vector<std::uint32_t> inputs_;
    std::vector<RegisterWrite> list_;
};

}  // namespace mw::mesa

// SPDX-License-Identifier: GPL-2.0-or-later
// A board for tests: a map of registers with a record of writes, and failures set by the test.
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "drivers/mesa/hostmot2/register_bus.hh"

namespace mw::mesa::test {

class MemoryBus final : public RegisterBus {
  public:
    std::string name = "test";
    std::vector<std::string> connector_names{"P1"};
    std::map<std::uint16_t, std::uint32_t> registers;
    /// Called after each write of a register, so that a test can simulate a module.
    std::function<void(RegisterWrite)> on_write;
    /// Called instead of a write while loading.
    std::function<void(RegisterWrite)> on_load_write;
    /// Simulates registers whose reads have an effect, such as FIFOs; nothing: the map has the value.
    std::function<std::optional<std::uint32_t>(std::uint16_t)> on_read_register;
    /// Called before each read of a cycle.
    std::function<void()> on_read;
    /// Result of the next read. With `next_write_lost` the next write is lost, so that the bus requires all
    /// registers afterwards.
    CycleRead next_read = CycleRead::DONE;
    bool next_write_lost = false;
    bool next_write_rejected = false;  ///< it cannot be sent
    bool read_rejected = false;        ///< while loading
    bool rewrite_wanted = false;
    int reads = 0;

    std::vector<RegisterRange> ranges;
    int max_writes = 0;
    std::vector<std::vector<RegisterWrite>> written;  ///< the list of each cycle
    std::vector<RegisterWrite> loading_writes;

    MemoryBus() { written.reserve(1 << 16); }

    /// The value that the last cycle wrote to a register; -1: none.
    std::int64_t last(std::uint16_t address) const {
        if (!written.empty()) {
            for (auto i = written.back().rbegin(); i != written.back().rend(); ++i) {
                if (i->address == address) {
                    return i->value;
                }
            }
        }
        return -1;
    }

    std::string card_name() const override { return name; }
    int width = 0;
    int port_width() const override { return width; }
    std::vector<std::string> connectors() const override { return connector_names; }
    Result<std::vector<std::uint32_t>> read_now(RegisterRange range) override {
        if (read_rejected) {
            return fail("The board does not answer.");
        }
        std::vector<std::uint32_t> values;
        for (int i = 0; i < range.count; ++i) {
            values.push_back(registers[static_cast<std::uint16_t>(range.address + 4 * i)]);
        }
        return values;
    }
    Result<> write_now(std::uint16_t address, std::span<const std::uint32_t> values) override {
        for (const std::uint32_t value : values) {
            loading_writes.push_back({address, value});
            if (on_load_write) {
                on_load_write({address, value});
            } else {
                registers[address] = value;
            }
            address = static_cast<std::uint16_t>(address + 4);
        }
        return {};
    }
    Result<> set_lists(std::span<const RegisterRange> list, int most_writes) override {
        ranges.assign(list.begin(), list.end());
        max_writes = most_writes;
        for (const RegisterRange &range : ranges) {
            for (int i = 0; i < range.count; ++i) {
                registers.try_emplace(static_cast<std::uint16_t>(range.address + 4 * i), 0);
            }
        }
        return {};
    }
    void request() noexcept override {}
    CycleRead read(std::span<std::uint32_t> values, long) noexcept override {
        ++reads;
        if (on_read) {
            on_read();
        }
        const CycleRead result = next_read;
        next_read = CycleRead::DONE;
        if (result != CycleRead::DONE) {
            rewrite_wanted = true;
            return result;
        }
        std::size_t n = 0;
        for (const RegisterRange &range : ranges) {
            for (int i = 0; i < range.count; ++i) {
                const auto address = static_cast<std::uint16_t>(range.address + 4 * i);
                if (const auto own = on_read_register ? on_read_register(address) : std::nullopt) {
                    values[n++] = *own;
                    continue;
                }
                const auto found = registers.find(address);
                values[n++] = found == registers.end() ? 0U : found->second;
            }
        }
        return result;
    }
    bool redirect(int range, std::uint16_t address) noexcept override {
        ranges[static_cast<std::size_t>(range)].address = address;
        return true;
    }
    bool write(std::span<const RegisterWrite> writes) noexcept override {
        if (next_write_rejected) {
            next_write_rejected = false;
            return false;
        }
        if (recording) {
            written.emplace_back(writes.begin(), writes.end());
        }
        if (next_write_lost) {
            next_write_lost = false;
            rewrite_wanted = true;
            return true;
        }
        for (const RegisterWrite &write : writes) {
            if (recording || registers.contains(write.address)) {
                registers[write.address] = write.value;
            }
            if (on_write) {
                on_write(write);
            }
        }
        return true;
    }
    bool immediate = false;
    std::vector<RegisterWrite> immediate_writes;
    bool hasImmediateAccess() const noexcept override { return immediate; }
    bool read_immediately(std::uint16_t address, std::span<std::uint32_t> values) noexcept override {
        for (std::uint32_t &value : values) {
            const auto found = registers.find(address);
            value = found == registers.end() ? 0U : found->second;
            address = static_cast<std::uint16_t>(address + 4);
        }
        return true;
    }
    bool write_immediately(std::span<const RegisterWrite> writes) noexcept override {
        immediate_writes.assign(writes.begin(), writes.end());
        for (const RegisterWrite &write : writes) {
            registers[write.address] = write.value;
        }
        return true;
    }
    bool take_rewrite() noexcept override {
        const bool wanted = rewrite_wanted;
        rewrite_wanted = false;
        return wanted;
    }
    bool recording = true;  ///< the record allocates memory
};

}  // namespace mw::mesa::test

// SPDX-License-Identifier: GPL-2.0-or-later
// The registers of a PCI card: 64 KiB of mapped memory, each access 32 bits wide.
#pragma once

#include <cstdint>
#include <functional>

#include "drivers/mesa/direct/register_access.hh"

namespace mw::mesa {

constexpr std::size_t PCI_REGISTER_BYTES = 0x10000;

/// An access to PCI reports no errors: a removed card reads as ones.
class PciRegisters final : public RegisterAccess {
  public:
    /// `registers` has PCI_REGISTER_BYTES; `release` is called at the end.
    explicit PciRegisters(volatile std::uint32_t *registers, std::function<void()> release = {})
        : registers_(registers), release_(std::move(release)) {}
    ~PciRegisters() override {
        if (release_) {
            release_();
        }
    }
    PciRegisters(const PciRegisters &) = delete;
    PciRegisters &operator=(const PciRegisters &) = delete;

    bool read(std::uint16_t address, std::span<std::uint32_t> values) noexcept override {
        for (std::size_t i = 0; i < values.size(); ++i) {
            values[i] = registers_[word_of(address, i)];
        }
        return true;
    }
    bool write(std::uint16_t address, std::span<const std::uint32_t> values) noexcept override {
        for (std::size_t i = 0; i < values.size(); ++i) {
            registers_[word_of(address, i)] = values[i];
        }
        return true;
    }
    bool isImmediate() const noexcept override { return true; }

  private:
    /// The addresses wrap, so that no access is out of range.
    static constexpr std::size_t word_of(std::uint16_t address, std::size_t i) noexcept {
        return (address / 4U + i) % (PCI_REGISTER_BYTES / 4);
    }
    volatile std::uint32_t *registers_;
    std::function<void()> release_;
};

}  // namespace mw::mesa

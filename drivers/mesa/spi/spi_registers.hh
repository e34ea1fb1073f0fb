// SPDX-License-Identifier: GPL-2.0-or-later
// The registers of a board on SPI: one transfer for all reads of a cycle, and one for all writes.
#pragma once

#include <memory>
#include <vector>

#include "drivers/mesa/direct/register_access.hh"
#include "drivers/mesa/spi/spi_device.hh"

namespace mw::mesa::spi {

class SpiRegisters final : public RegisterAccess {
  public:
    explicit SpiRegisters(std::unique_ptr<Device> device);
    ~SpiRegisters() override;
    SpiRegisters(const SpiRegisters &) = delete;
    SpiRegisters &operator=(const SpiRegisters &) = delete;

    bool read(std::uint16_t address, std::span<std::uint32_t> values) noexcept override;
    bool write(std::uint16_t address, std::span<const std::uint32_t> values) noexcept override;
    Result<> prepare(std::span<const RegisterRange> reads, int max_writes) override;
    bool read_list(std::span<const RegisterRange> ranges, std::span<std::uint32_t> values) noexcept override;
    bool write_list(std::span<const RegisterWrite> writes) noexcept override;
    int last_error() const noexcept override { return last_error_; }

  private:
    bool append(std::uint32_t word) noexcept;
    bool transfer(Direction direction) noexcept;

    std::unique_ptr<Device> device_;
    std::vector<std::uint32_t> words_;  ///< as long as the largest transfer
    std::size_t used_ = 0;
    int last_error_ = 0;
};

}  // namespace mw::mesa::spi

// SPDX-License-Identifier: GPL-2.0-or-later
// The registers of a board behind a parallel port in EPP mode.
#pragma once

#include <memory>

#include "drivers/mesa/direct/register_access.hh"
#include "drivers/mesa/epp/epp_port.hh"

namespace mw::mesa::epp {

/// Whether the port accepts 32 bits in one access.
enum class Width : std::uint8_t { BYTES, WIDE };

class EppRegisters final : public RegisterAccess {
  public:
    EppRegisters(std::unique_ptr<Port> port, Width width);
    ~EppRegisters() override;
    EppRegisters(const EppRegisters &) = delete;
    EppRegisters &operator=(const EppRegisters &) = delete;

    /// False when the port reports a time-out, which is then cleared.
    bool read(std::uint16_t address, std::span<std::uint32_t> values) noexcept override;
    bool write(std::uint16_t address, std::span<const std::uint32_t> values) noexcept override;
    /// ETIMEDOUT after a time-out.
    int last_error() const noexcept override { return last_error_; }

  private:
    void begin() noexcept;
    void send_address(std::uint16_t address) noexcept;
    bool finish() noexcept;

    std::unique_ptr<Port> port_;
    Width width_;
    int last_error_ = 0;
};

}  // namespace mw::mesa::epp

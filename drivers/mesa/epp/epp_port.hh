// SPDX-License-Identifier: GPL-2.0-or-later
// The registers of a parallel port in EPP mode.
#pragma once

#include <cstdint>

#include "drivers/mesa/epp/epp_codec.hh"

namespace mw::mesa::epp {

class Port {
  public:
    virtual ~Port() = default;
    virtual std::uint8_t read(Register reg) noexcept = 0;
    virtual void write(Register reg, std::uint8_t value) noexcept = 0;
    /// An access of 32 bits to the data register. The port makes four EPP accesses, lowest byte first.
    virtual std::uint32_t read_wide() noexcept = 0;
    virtual void write_wide(std::uint32_t value) noexcept = 0;
};

}  // namespace mw::mesa::epp

// SPDX-License-Identifier: GPL-2.0-or-later
// Access to the registers of a parallel port: directly, through the kernel's driver, or simulated.
#pragma once

#include <array>
#include <cstdint>

#include "drivers/parport/lines.hh"
#include "rtapi_parport.h"

namespace mw::parport {

/// The registers of one port. [any thread; no allocation]
class PortAccess {
  public:
    virtual std::uint8_t read(Register reg) noexcept = 0;
    virtual void write(Register reg, std::uint8_t value) noexcept = 0;
    /// Selects the mode of the chip if it has the register for it. [while loading]
    virtual void select(Mode mode) noexcept = 0;
    virtual void release() noexcept = 0;

  protected:
    ~PortAccess() = default;
};

/// Reads and writes the I/O ports of the computer; the process needs CAP_SYS_RAWIO.
class DirectAccess final : public PortAccess {
  public:
    /// 0, or a negated errno with a message in the log. [while loading]
    int open(const char *module, std::uint16_t address) noexcept;

    std::uint8_t read(Register reg) noexcept override;
    void write(Register reg, std::uint8_t value) noexcept override;
    void select(Mode mode) noexcept override;
    void release() noexcept override;

  private:
    rtapi_parport_t port_{};
};

/// Uses /dev/parportN of Linux, for users without CAP_SYS_RAWIO.
class DeviceAccess final : public PortAccess {
  public:
    /// `number` of the port; 0, or a negated errno with a message in the log. [while loading]
    int open(const char *module, int number) noexcept;

    std::uint8_t read(Register reg) noexcept override;
    void write(Register reg, std::uint8_t value) noexcept override;
    void select(Mode mode) noexcept override;
    void release() noexcept override;

  private:
    int file_ = -1;
};

/// A port in memory: outputs keep their values, and inputs have the levels that set_level() sets.
class SimulatedAccess final : public PortAccess {
  public:
    std::uint8_t read(Register reg) noexcept override;
    void write(Register reg, std::uint8_t value) noexcept override;
    void select(Mode mode) noexcept override { mode_ = mode; }
    void release() noexcept override {}

    /// Sets the level of an input pin.
    void set_level(const Line &line, bool high) noexcept;
    /// The level that an output pin has.
    bool level(const Line &line) const noexcept;

  private:
    static constexpr std::size_t index(Register reg) noexcept { return static_cast<std::size_t>(reg); }

    std::array<std::uint8_t, 3> written_{}, inputs_{};
    Mode mode_ = Mode::OUT;
};

}  // namespace mw::parport

// SPDX-License-Identifier: GPL-2.0-or-later
// The IO ports and the driver of each pin. Source: shared/hardware.md, part B3.
#pragma once

#include <functional>
#include <vector>

#include "drivers/mesa/board/modules/module.hh"

namespace mw::mesa::board {

/// The registers of one port, one bit for each pin.
struct IoPort {
    std::uint32_t data = 0;        ///< written value; a read returns the levels of the pins
    std::uint32_t direction = 0;   ///< 1: output
    std::uint32_t alternate = 0;   ///< 1: the module drives the pin
    std::uint32_t open_drain = 0;  ///< 1: driven low or not driven, for both directions
    std::uint32_t inverted = 0;
};

/// Drive of a pin by the board.
enum class Drive : std::uint8_t { NONE, LOW, HIGH };

/// `module_level` is the output of the module of that pin, if it has one.
Drive drive_of(const IoPort &port, unsigned bit, bool module_level);

/// Registers: data, direction, alternate source, open drain, invert; one instance for each port.
class IoPorts final : public Module {
  public:
    /// The level of a pin that the board does not drive, and that of its module's output; pins of the whole
    /// board.
    struct Levels {
        std::function<bool(unsigned pin)> outside, module;
    };
    IoPorts(unsigned ports, unsigned port_width);
    void connect(Levels levels) { levels_ = std::move(levels); }

    std::uint32_t read(RegisterPlace place) override;
    void write(RegisterPlace place, std::uint32_t value) override;
    unsigned registers() const override { return 5; }

    Drive drive(unsigned pin) const;
    bool level(unsigned pin) const;
    /// True if the module drives the pin, by its direction and source.
    bool isDrivenByModule(unsigned pin) const;
    /// For a bite of the watchdog: all pins become inputs.
    void release_all();
    unsigned pins() const { return static_cast<unsigned>(ports_.size()) * port_width_; }

  private:
    std::vector<IoPort> ports_;
    unsigned port_width_;
    Levels levels_;
};

}  // namespace mw::mesa::board

// SPDX-License-Identifier: GPL-2.0-or-later
// The pins of a board as general inputs and outputs, and the pins used by modules. Registers:
// shared/hardware.md, part B3.
#pragma once

#include <array>

#include "drivers/mesa/hostmot2/module.hh"
#include "drivers/mesa/identity/cards.hh"

namespace mw::mesa {

struct GpioPins {
    bool in = false, in_not = false, out = false;
    bool is_output = false, invert_output = false, is_opendrain = false;
};

/// The registers of one port; bit n is pin n of the port.
struct PortWords {
    std::uint32_t data = 0, direction = 0, source = 0, open_drain = 0, invert = 0;

    bool operator==(const PortWords &) const = default;
};

/// The words of a port from its pins. `used` and `pins` belong to the port, at most 32.
PortWords port_words(std::span<const UsedPin> used, std::span<const GpioPins> pins) noexcept;

class IoPorts final : public Module {
  public:
    IoPorts(const UsedModule &module, const Assignment &assignment, int port_width);

    void plan(Registers &registers) override;
    void declare(PinSpace &space) override;
    void read(const Registers &registers, const Cycle &cycle) noexcept override;
    void write(Registers &registers, const Cycle &cycle) noexcept override;

    /// Read and write the general pins immediately, for read_gpio and write_gpio. They use separate values,
    /// so they do not affect the thread of the cycle. [one realtime thread, after declare()]
    void read_immediately(RegisterBus &bus) noexcept;
    void write_immediately(RegisterBus &bus) noexcept;

  private:
    struct Port {
        WriteHandle data, direction, source, open_drain, invert;
        int first = 0, count = 0;  ///< its pins
    };

    /// The pins as seen by one thread.
    struct View {
        std::vector<GpioPins> pins;
        PinBinding inputs, outputs;
    };
    PortWords words_of(const View &view, const Port &port) const noexcept;
    void show(View &view, const Port &port, std::uint32_t word) const noexcept;

    UsedModule module_;
    std::vector<UsedPin> used_;
    std::vector<Port> ports_;
    View cycle_, fast_;
    std::vector<PortWords> sent_;  ///< last words sent by write_immediately()
    ReadHandle data_;
};

/// The name of an output of a module in HAL, such as "stepgen.00.step"; empty if it has none.
std::string output_name(const UsedPin &pin);

}  // namespace mw::mesa

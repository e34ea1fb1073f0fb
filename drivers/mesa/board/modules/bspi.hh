// SPDX-License-Identifier: GPL-2.0-or-later
// Buffered SPI: 16 channels, each with a descriptor of its frames. Sources: shared/hardware.md, part B10; the
// descriptor is the one that LinuxCNC's mesa_7i65 writes. Without a peer the data return, as with a wire from
// output to input.
#pragma once

#include <array>
#include <deque>
#include <functional>
#include <vector>

#include "drivers/mesa/board/modules/module.hh"

namespace mw::mesa::board {

constexpr unsigned BSPI_CHANNELS = 16;

/// Registers: data (a word for each channel: a write is a frame, a read takes the next answer), descriptors
/// (4 to 0 bits of the frame less 1, 19 to 16 channel, 31 the answer is not kept), answers that wait (a write
/// of it empties them). An exchange takes no time.
class BspiModule final : public Module {
  public:
    explicit BspiModule(unsigned instances) : ports_(instances) {}
    /// Answer of the device on a channel to a frame.
    using Device = std::function<std::uint32_t(unsigned channel, std::uint32_t frame)>;
    void connect(unsigned instance, Device device) { ports_[instance].device = std::move(device); }

    std::uint32_t read(RegisterPlace place) override;
    void write(RegisterPlace place, std::uint32_t value) override;
    unsigned registers() const override { return 3; }
    unsigned words(unsigned reg) const override { return reg == 0 ? BSPI_CHANNELS : 1; }

  private:
    struct Port {
        std::array<std::uint32_t, BSPI_CHANNELS> descriptors{};
        std::deque<std::uint32_t> answers;
        Device device;
    };
    std::vector<Port> ports_;
};

}  // namespace mw::mesa::board

// SPDX-License-Identifier: GPL-2.0-or-later
// Loading and unloading of a board.
#include <algorithm>

#include "drivers/mesa/spi/spi_codec.hh"
#include "drivers/mesa/spi/spi_registers.hh"

namespace mw::mesa::spi {

namespace {

/// Registers read at once while loading, with their commands.
constexpr std::size_t LEAST_ROOM = 512;

}  // namespace

SpiRegisters::SpiRegisters(std::unique_ptr<Device> device) : device_(std::move(device)), words_(LEAST_ROOM) {}

SpiRegisters::~SpiRegisters() = default;

Result<> SpiRegisters::prepare(std::span<const RegisterRange> reads, int max_writes) {
    std::size_t room = std::max(LEAST_ROOM, 2 * static_cast<std::size_t>(std::max(max_writes, 0)));
    std::size_t read_words = 0;
    for (const RegisterRange &range : reads) {
        read_words += transfer_words(range.count);
    }
    room = std::max(room, read_words);
    words_.assign(room, 0);
    return {};
}

}  // namespace mw::mesa::spi

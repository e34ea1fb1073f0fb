// SPDX-License-Identifier: GPL-2.0-or-later
// An SPI bus with a simulated board: it decodes the words of a transfer one after the other, as the board
// does.
#pragma once

#include <vector>

#include "drivers/mesa/direct/test/rig.hh"
#include "drivers/mesa/spi/spi_device.hh"

namespace mw::mesa::test {

/// A transfer as sent.
struct SentTransfer {
    std::vector<std::uint32_t> words;
    spi::Direction direction = spi::Direction::READS;
};

class SimulatedDevice final : public spi::Device {
  public:
    explicit SimulatedDevice(Wire &wire, std::vector<SentTransfer> *log = nullptr) : wire_(wire), log_(log) {}

    int transfer(std::span<std::uint32_t> words, spi::Direction direction) noexcept override {
        if (log_ != nullptr) {
            log_->push_back({{words.begin(), words.end()}, direction});
        }
        std::uint32_t command = 0, left = 0;
        std::uint16_t address = 0;
        for (std::uint32_t &word : words) {
            const std::uint32_t sent = word;
            word = wire_.is_cut ? wire_.floating : 0;
            if (left == 0) {
                command = sent;
                left = (command >> 4U) & 0x7FU;
                address = static_cast<std::uint16_t>(command >> 16U);
                continue;
            }
            if (!wire_.is_cut) {
                exchange(command, address, sent, word);
            }
            address = static_cast<std::uint16_t>(address + ((command & 0x800U) != 0 ? 4 : 0));
            --left;
        }
        return wire_.error;
    }

  private:
    void exchange(std::uint32_t command, std::uint16_t address, std::uint32_t sent, std::uint32_t &received) {
        switch ((command >> 12U) & 0xFU) {
        case 0xA: received = wire_.board.firmware().read(address); break;
        case 0xB: wire_.board.firmware().write(address, sent); break;
        default: break;
        }
    }
    Wire &wire_;
    std::vector<SentTransfer> *log_;
};

}  // namespace mw::mesa::test

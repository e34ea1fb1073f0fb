// SPDX-License-Identifier: GPL-2.0-or-later
#include "drivers/mesa/board/modules/bspi.hh"

namespace mw::mesa::board {

namespace {

enum : unsigned { DATA, DESCRIPTOR, COUNT };
constexpr std::uint32_t BITS_MASK = 0x1F, CHANNEL_SHIFT = 16, CHANNEL_MASK = 0xF, NO_ANSWER = 1U << 31U;
constexpr std::size_t FIFO_WORDS = 16;

std::uint32_t mask_of(std::uint32_t descriptor) {
    return 0xFFFFFFFFU >> (31U - (descriptor & BITS_MASK));
}

}  // namespace

std::uint32_t BspiModule::read(RegisterPlace place) {
    Port &port = ports_[place.instance];
    if (place.reg == COUNT) {
        return static_cast<std::uint32_t>(port.answers.size());
    }
    if (place.reg != DATA || port.answers.empty()) {
        return 0;
    }
    const std::uint32_t value = port.answers.front();
    port.answers.pop_front();
    return value;
}

void BspiModule::write(RegisterPlace place, std::uint32_t value) {
    Port &port = ports_[place.instance];
    if (place.reg == DESCRIPTOR) {
        port.descriptors[(value >> CHANNEL_SHIFT) & CHANNEL_MASK] = value;
    } else if (place.reg == COUNT) {
        port.answers.clear();
    } else {
        const std::uint32_t descriptor = port.descriptors[place.word];
        const std::uint32_t frame = value & mask_of(descriptor);
        const std::uint32_t answer =
            port.device ? port.device(place.word, frame) & mask_of(descriptor) : frame;
        if ((descriptor & NO_ANSWER) == 0 && port.answers.size() < FIFO_WORDS) {
            port.answers.push_back(answer);
        }
    }
}

}  // namespace mw::mesa::board

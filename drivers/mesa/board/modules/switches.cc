// SPDX-License-Identifier: GPL-2.0-or-later
#include "drivers/mesa/board/modules/switches.hh"

namespace mw::mesa::board {

namespace {

enum : unsigned { CONTROL, SLOW, FILTERED, RAW };
constexpr std::uint32_t HIGHEST_INPUT = 0x1F;

}  // namespace

std::uint32_t InputModule::read(RegisterPlace place) {
    switch (place.reg) {
    case CONTROL: return (control_ & ~HIGHEST_INPUT) | ((inputs_ - 1) & HIGHEST_INPUT);
    case SLOW: return slow_;
    case FILTERED:
    case RAW: return levels_ ? levels_() : 0;
    default: return 0;
    }
}

void InputModule::write(RegisterPlace place, std::uint32_t value) {
    if (place.reg == CONTROL) {
        control_ = value;
    } else if (place.reg == SLOW) {
        slow_ = value;
    }
}

}  // namespace mw::mesa::board

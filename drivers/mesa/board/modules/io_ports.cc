// SPDX-License-Identifier: GPL-2.0-or-later
#include "drivers/mesa/board/modules/io_ports.hh"

namespace mw::mesa::board {

namespace {

enum : unsigned { DATA, DIRECTION, ALTERNATE, OPEN_DRAIN, INVERT };

bool has_bit(std::uint32_t word, unsigned bit) {
    return ((word >> bit) & 1U) != 0;
}

std::uint32_t *register_of(IoPort &port, unsigned reg) {
    switch (reg) {
    case DATA: return &port.data;
    case DIRECTION: return &port.direction;
    case ALTERNATE: return &port.alternate;
    case OPEN_DRAIN: return &port.open_drain;
    case INVERT: return &port.inverted;
    default: return nullptr;
    }
}

}  // namespace

Drive drive_of(const IoPort &port, unsigned bit, bool module_level) {
    const bool source = has_bit(port.alternate, bit) ? module_level : has_bit(port.data, bit);
    const bool level = source != has_bit(port.inverted, bit);
    if (has_bit(port.open_drain, bit)) {
        return level ? Drive::NONE : Drive::LOW;
    }
    if (!has_bit(port.direction, bit)) {
        return Drive::NONE;
    }
    return level ? Drive::HIGH : Drive::LOW;
}

IoPorts::IoPorts(unsigned ports, unsigned port_width) : ports_(ports), port_width_(port_width) {}

std::uint32_t IoPorts::read(RegisterPlace place) {
    if (place.reg != DATA) {
        const std::uint32_t *word = register_of(ports_[place.instance], place.reg);
        return word == nullptr ? 0 : *word;
    }
    std::uint32_t levels = 0;
    for (unsigned bit = 0; bit < port_width_; ++bit) {
        levels |= static_cast<std::uint32_t>(level(place.instance * port_width_ + bit)) << bit;
    }
    return levels;
}

void IoPorts::write(RegisterPlace place, std::uint32_t value) {
    std::uint32_t *word = register_of(ports_[place.instance], place.reg);
    if (word != nullptr) {
        const std::uint32_t mask = port_width_ >= 32 ? ~0U : (1U << port_width_) - 1U;
        *word = value & mask;
    }
}

Drive IoPorts::drive(unsigned pin) const {
    const bool module_level = levels_.module && levels_.module(pin);
    return drive_of(ports_[pin / port_width_], pin % port_width_, module_level);
}

bool IoPorts::level(unsigned pin) const {
    const Drive drive = this->drive(pin);
    if (drive == Drive::NONE) {
        return !levels_.outside || levels_.outside(pin);
    }
    return drive == Drive::HIGH;
}

bool IoPorts::isDrivenByModule(unsigned pin) const {
    const IoPort &port = ports_[pin / port_width_];
    const unsigned bit = pin % port_width_;
    return has_bit(port.alternate, bit) && (has_bit(port.direction, bit) || has_bit(port.open_drain, bit));
}

void IoPorts::release_all() {
    for (IoPort &port : ports_) {
        port.direction = 0;
        port.open_drain = 0;
    }
}

}  // namespace mw::mesa::board

// SPDX-License-Identifier: GPL-2.0-or-later
#include "drivers/mesa/hostmot2/pins.hh"

#include <bit>
#include <cstddef>

namespace mw::mesa {

namespace {

template <class T>
std::uint64_t bits_of(T value) noexcept {
    if constexpr (sizeof(T) == sizeof(std::uint64_t)) {
        return std::bit_cast<std::uint64_t>(value);
    } else {
        return static_cast<std::uint64_t>(value);
    }
}

/// Calls `act` with the value in HAL and the field, as references of the type.
template <class Act>
void with_type(PinType type, void *hal, void *field, Act &&act) noexcept {
    switch (type) {
    case PinType::BIT: act(*static_cast<volatile bool *>(hal), *static_cast<bool *>(field)); break;
    case PinType::FLOAT: act(*static_cast<volatile double *>(hal), *static_cast<double *>(field)); break;
    case PinType::S32:
        act(*static_cast<volatile std::int32_t *>(hal), *static_cast<std::int32_t *>(field));
        break;
    case PinType::U32:
        act(*static_cast<volatile std::uint32_t *>(hal), *static_cast<std::uint32_t *>(field));
        break;
    }
}

}  // namespace

void PinBinding::add(PinSpace &space, const std::string &name, PinType type, Access access, void *field) {
    Bound pin{space.make(name, type, access), field, 0, type, access};
    if (pin.slot == nullptr) {
        return;  // the space keeps the error
    }
    with_type(type, *pin.slot, field, [&](auto &hal, auto &value) {
        hal = value;
        pin.loaded = bits_of(value);
    });
    pins_.push_back(pin);
}

PinBinding PinBinding::moved(const void *from, void *to) const {
    PinBinding copy = *this;
    for (Bound &pin : copy.pins_) {
        const auto offset = static_cast<const std::byte *>(pin.field) - static_cast<const std::byte *>(from);
        pin.field = static_cast<std::byte *>(to) + offset;
    }
    return copy;
}

void PinBinding::load() noexcept {
    for (Bound &pin : pins_) {
        if (pin.access != Access::OUT && pin.access != Access::RO) {
            with_type(pin.type, *pin.slot, pin.field, [&](auto &hal, auto &value) {
                value = hal;
                pin.loaded = bits_of(value);
            });
        }
    }
}

void PinBinding::store() noexcept {
    for (const Bound &pin : pins_) {
        if (pin.access == Access::IN) {
            continue;
        }
        const bool own = pin.access == Access::OUT || pin.access == Access::RO;
        with_type(pin.type, *pin.slot, pin.field, [&](auto &hal, auto &value) {
            if (own || bits_of(value) != pin.loaded) {
                hal = value;
            }
        });
    }
}

}  // namespace mw::mesa

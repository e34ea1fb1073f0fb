// SPDX-License-Identifier: GPL-2.0-or-later
#include "drivers/mesa/hostmot2/hal/hal_pins.hh"

#include <cerrno>

#include "hal.h"

namespace mw::mesa {

namespace {

hal_type_t hal_type(PinType type) noexcept {
    switch (type) {
    case PinType::BIT: return HAL_BIT;
    case PinType::FLOAT: return HAL_FLOAT;
    case PinType::S32: return HAL_S32;
    case PinType::U32: break;
    }
    return HAL_U32;
}

hal_pdir_t hal_direction(Access access) noexcept {
    switch (access) {
    case Access::IN: return HAL_IN;
    case Access::OUT: return HAL_OUT;
    case Access::IO: return HAL_IO;
    case Access::RW: return HAL_RW;
    case Access::RO: break;
    }
    return HAL_RO;
}

/// A pin's slot, which HAL updates, or a parameter with its value.
struct Cell {
    void *slot;
    std::uint64_t value;
};

}  // namespace

void *const volatile *HalPins::make(const std::string &name, PinType type, Access access) {
    auto *cell = static_cast<Cell *>(hal_malloc(sizeof(Cell)));
    if (cell == nullptr) {
        keep(-ENOMEM);
        return nullptr;
    }
    cell->value = 0;
    cell->slot = &cell->value;
    const std::string full = whole(name);
    const bool is_param = access == Access::RW || access == Access::RO;
    const int status =
        is_param ? hal_param_new(full.c_str(), hal_type(type), hal_direction(access), &cell->value, comp_id_)
                 : hal_pin_new(full.c_str(), hal_type(type), hal_direction(access), &cell->slot, comp_id_);
    keep(status);
    return status < 0 ? nullptr : &cell->slot;
}

void HalPins::alias_param(const std::string &name, const std::string &alias) {
    keep(hal_param_alias(whole(name).c_str(), whole(alias).c_str()));
}

}  // namespace mw::mesa

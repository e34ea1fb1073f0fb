// SPDX-License-Identifier: GPL-2.0-or-later
// Typed handles to pins of a component in an ordinary program.
#pragma once

#include <cstdint>
#include <string>
#include <type_traits>

#include "hal/core/instance.hh"

namespace mw::hal {

/// A pin of this process: reads and assigns like a T. [the thread that owns the component]
template <class T>
class UserPin {
  public:
    /// Creates the pin; `status` keeps the first failure of several calls.
    void make(Instance &hal, int comp_id, const std::string &name, Dir dir, Result<> &status) {
        if (!status.has_value()) {
            return;
        }
        const auto slot = hal.pins().create(name, type(), dir, comp_id);
        if (slot.has_value()) {
            slot_ = *slot;
        } else {
            status = std::unexpected(slot.error());
        }
    }
    T get() const noexcept { return *static_cast<volatile T *>(*slot_); }
    void set(T value) noexcept { *static_cast<volatile T *>(*slot_) = value; }
    operator T() const noexcept { return get(); }
    UserPin &operator=(T value) noexcept {
        set(value);
        return *this;
    }

  private:
    static constexpr Type type() {
        if constexpr (std::is_same_v<T, bool>) {
            return Type::BIT;
        } else if constexpr (std::is_same_v<T, double>) {
            return Type::FLOAT;
        } else if constexpr (std::is_same_v<T, std::int32_t>) {
            return Type::S32;
        } else {
            static_assert(std::is_same_v<T, std::uint32_t>);
            return Type::U32;
        }
    }
    void *volatile *slot_ = nullptr;  // HAL changes it to the signal when the pin is linked
};

}  // namespace mw::hal

// SPDX-License-Identifier: GPL-2.0-or-later
// Pins and parameters of a component in C++.
#pragma once

#include <cstdint>
#include <type_traits>

#include "hal.h"

namespace mw::sdk {

template <class T>
constexpr hal_type_t type_of() noexcept {
    if constexpr (std::is_same_v<T, bool>) {
        return HAL_BIT;
    } else if constexpr (std::is_same_v<T, double>) {
        return HAL_FLOAT;
    } else if constexpr (std::is_same_v<T, std::int32_t>) {
        return HAL_S32;
    } else if constexpr (std::is_same_v<T, std::uint32_t>) {
        return HAL_U32;
    } else if constexpr (std::is_same_v<T, std::int64_t>) {
        return HAL_S64;
    } else {
        static_assert(std::is_same_v<T, std::uint64_t>,
                      "a pin is bool, double, int32, uint32, int64 or uint64");
        return HAL_U64;
    }
}

/// A pin: reads and assigns like a T. Each use is one access to the value in HAL memory, which another thread
/// or process may change; copy it to a local variable if a function needs a constant value. [any thread]
template <class T, hal_pin_dir_t DIR>
class Pin {
  public:
    static constexpr hal_pin_dir_t DIRECTION = DIR;
    using Value = T;

    T get() const noexcept { return *slot_; }
    void set(T value) noexcept { *slot_ = value; }
    operator T() const noexcept { return *slot_; }
    Pin &operator=(T value) noexcept {
        *slot_ = value;
        return *this;
    }
    Pin() = default;
    Pin(const Pin &) = delete;
    Pin &operator=(const Pin &) = delete;

  private:
    friend class Declare;
    volatile T *slot_ = nullptr;  // the C API updates it
};

template <class T>
using In = Pin<T, HAL_IN>;
template <class T>
using Out = Pin<T, HAL_OUT>;
template <class T>
using InOut = Pin<T, HAL_IO>;

/// A parameter: a value beside the pins. [any thread]
template <class T, hal_param_dir_t DIR>
class Param {
  public:
    static constexpr hal_param_dir_t DIRECTION = DIR;
    T get() const noexcept { return value_; }
    void set(T value) noexcept { value_ = value; }
    operator T() const noexcept { return value_; }
    Param &operator=(T value) noexcept {
        value_ = value;
        return *this;
    }
    Param() = default;
    Param(const Param &) = delete;
    Param &operator=(const Param &) = delete;

  private:
    friend class Declare;
    alignas(8) volatile T value_{};
};

template <class T>
using ParamRw = Param<T, HAL_RW>;
template <class T>
using ParamRo = Param<T, HAL_RO>;

}  // namespace mw::sdk

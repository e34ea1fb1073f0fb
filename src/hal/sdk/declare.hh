// SPDX-License-Identifier: GPL-2.0-or-later
// Declarations of a C++ component: pins, parameters and functions with the prefix of an instance.
#pragma once

#include <cerrno>
#include <type_traits>

#include "pins.hh"
#include "rtapi_app.h"

namespace mw::sdk {

/// Creates the pins, parameters and functions of one instance. The first failure is kept and ends the
/// loading; its message has been logged. [while loading]
class Declare {
  public:
    /// Copies `prefix`, which may be a temporary. If it is too long, every name fails.
    Declare(int comp_id, const char *prefix, int index) noexcept : comp_id_(comp_id), index_(index) {
        rtapi_snprintf(prefix_, sizeof prefix_, "%s", prefix);
    }

    /// Creates the pin PREFIX.NAME (only PREFIX when `name` is empty).
    template <class T, hal_pin_dir_t DIR>
    void pin(Pin<T, DIR> &pin, const char *name, std::type_identity_t<T> start = T{}) noexcept {
        char full[NAME_SIZE];
        if (isNamed(full, name) &&
            keep(hal_pin_new(full, type_of<T>(), DIR, reinterpret_cast<void **>(const_cast<T **>(&pin.slot_)),
                             comp_id_))) {
            pin = start;
        }
    }

    /// Creates the parameter PREFIX.NAME.
    template <class T, hal_param_dir_t DIR>
    void param(Param<T, DIR> &param, const char *name, std::type_identity_t<T> start = T{}) noexcept {
        char full[NAME_SIZE];
        param = start;
        if (isNamed(full, name)) {
            keep(hal_param_new(full, type_of<T>(), DIR, const_cast<T *>(&param.value_), comp_id_));
        }
    }

    /// Creates the pin PREFIX.NAME by the naming rules, with its `legacy` name for older HAL files.
    template <class T, hal_pin_dir_t DIR>
    void legacy_pin(Pin<T, DIR> &renamed, const char *name, const char *legacy,
                    std::type_identity_t<T> start = T{}) noexcept {
        pin(renamed, legacy, start);
        char full[NAME_SIZE], full_legacy[NAME_SIZE];
        if (status_ == 0 && isNamed(full, name) && isNamed(full_legacy, legacy)) {
            keep(hal_pin_alias(full_legacy, full));
        }
    }

    /// Creates the parameter PREFIX.NAME by the naming rules, with its `legacy` name.
    template <class T, hal_param_dir_t DIR>
    void legacy_param(Param<T, DIR> &renamed, const char *name, const char *legacy,
                      std::type_identity_t<T> start = T{}) noexcept {
        param(renamed, legacy, start);
        char full[NAME_SIZE], full_legacy[NAME_SIZE];
        if (status_ == 0 && isNamed(full, name) && isNamed(full_legacy, legacy)) {
            keep(hal_param_alias(full_legacy, full));
        }
    }

    /// Creates a pin with its number formatted into the name, as in "in-%02d".
    template <class T, hal_pin_dir_t DIR>
    void pin_at(Pin<T, DIR> &numbered, const char *format, int number,
                std::type_identity_t<T> start = T{}) noexcept {
        char name[NAME_SIZE];
        rtapi_snprintf(name, sizeof name, format, number);
        pin(numbered, name, start);
    }

    /// Creates a parameter with its number formatted into the name.
    template <class T, hal_param_dir_t DIR>
    void param_at(Param<T, DIR> &numbered, const char *format, int number,
                  std::type_identity_t<T> start = T{}) noexcept {
        char name[NAME_SIZE];
        rtapi_snprintf(name, sizeof name, format, number);
        param(numbered, name, start);
    }

    /// The `wanted` number from personality= (0: `fallback`), from 0 to `max`; otherwise an error that names
    /// `what`.
    int personality_number(int wanted, int fallback, int max, const char *what) noexcept {
        const int number = wanted == 0 ? fallback : wanted;
        if (number < 0 || number > max) {
            rtapi_print_msg(RTAPI_MSG_ERR, "%s: personality=%d, but the number of %s is 0 to %d", prefix_,
                            number, what, max);
            keep(-EINVAL);
            return 0;
        }
        return number;
    }

    /// Creates the function PREFIX.NAME (only PREFIX without a name), which calls METHOD, a noexcept member
    /// without parameters or with the period [ns].
    template <auto METHOD, class Self>
    void function(Self *self, const char *name = "") noexcept {
        char full[NAME_SIZE];
        if (isNamed(full, name)) {
            keep(hal_export_funct(full, &call<METHOD, Self>, self, 1, 0, comp_id_));
        }
    }

    /// Keeps a failure of a C API call made outside this class; true if `status` is not a failure.
    bool keep(int status) noexcept {
        if (status < 0 && status_ == 0) {
            status_ = status;
        }
        return status >= 0;
    }

    int status() const noexcept { return status_; }
    int comp_id() const noexcept { return comp_id_; }
    const char *prefix() const noexcept { return prefix_; }
    /// The number of this instance, from 0.
    int index() const noexcept { return index_; }

  private:
    static constexpr int NAME_SIZE = HAL_NAME_LEN + 1;

    template <auto METHOD, class Self>
    static void call(void *self, long period_ns) noexcept {
        if constexpr (std::is_nothrow_invocable_v<decltype(METHOD), Self *, long>) {
            (static_cast<Self *>(self)->*METHOD)(period_ns);
        } else {
            static_assert(std::is_nothrow_invocable_v<decltype(METHOD), Self *>,
                          "void f() noexcept or (long) noexcept");
            (static_cast<Self *>(self)->*METHOD)();
        }
    }

    bool isNamed(char (&full)[NAME_SIZE], const char *name) noexcept {
        const char *dot = name[0] == '\0' ? "" : ".";
        if (rtapi_snprintf(full, sizeof full, "%s%s%s", prefix_, dot, name) >= NAME_SIZE) {
            rtapi_print_msg(RTAPI_MSG_ERR, "HAL name %s.%s is longer than %d characters", prefix_, name,
                            HAL_NAME_LEN);
            return keep(-EINVAL);
        }
        return true;
    }

    int comp_id_;
    char prefix_[NAME_SIZE + 1];
    int index_;
    int status_ = 0;
};

}  // namespace mw::sdk

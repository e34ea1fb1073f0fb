// SPDX-License-Identifier: GPL-2.0-or-later
// The C++ way to write a realtime component: a struct of pins and parameters, one function that declares
// them, and functions that run in the thread. Works with -fno-exceptions -fno-rtti; adds nothing at run time
// over the C API.
//
//     struct And2 {
//         mw::sdk::In<bool> in0, in1;
//         mw::sdk::Out<bool> out;
//
//         void declare(mw::sdk::Declare &d)
//         {
//             d.pin(in0, "in0");                    // and2.0.in0
//             d.pin(in1, "in1");
//             d.pin(out, "out");
//             d.function<&And2::update>(this);      // and2.0
//         }
//         void update() noexcept { out = in0 && in1; }
//     };
//     MW_COMPONENT(And2, "and2", 16)
//
// That component takes count=N (and2.0, and2.1, ...; at most 16) or names=a,b (a, b); one instance by
// default.
#pragma once

#include <cstdint>
#include <cstring>
#include <new>
#include <type_traits>

#include "hal.h"
#include "rtapi_app.h"

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

/// A pin: reads and assigns like a T. Each use is one access to the value in HAL memory, which others may
/// change in between; copy it into a local where one function must see one value. [any thread]
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
    volatile T *slot_ = nullptr;  // the C API keeps it pointing at the value
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

/// Makes the pins, parameters and functions of one instance. The first failure is kept and ends the loading;
/// what was wrong is in the log already. [while loading]
class Declare {
  public:
    Declare(int comp_id, const char *prefix, int index) noexcept
        : comp_id_(comp_id), prefix_(prefix), index_(index) {}

    /// The pin PREFIX.NAME (only PREFIX when `name` is empty).
    template <class T, hal_pin_dir_t DIR>
    void pin(Pin<T, DIR> &pin, const char *name, std::type_identity_t<T> start = T{}) noexcept {
        char full[NAME_SIZE];
        if (isNamed(full, name) &&
            keep(hal_pin_new(full, type_of<T>(), DIR, reinterpret_cast<void **>(const_cast<T **>(&pin.slot_)),
                             comp_id_))) {
            pin = start;
        }
    }

    /// The pin PREFIX.STEM<number><TAIL>, for arrays: pin_numbered(in[i], "in", i) is "in0", with tail "-x":
    /// "in0-x".
    template <class T, hal_pin_dir_t DIR>
    void pin_numbered(Pin<T, DIR> &numbered, const char *stem, int number, const char *tail = "") noexcept {
        char name[NAME_SIZE];
        if (rtapi_snprintf(name, sizeof name, "%s%d%s", stem, number, tail) >= NAME_SIZE) {
            keep(-EINVAL_);
            return;
        }
        pin(numbered, name);
    }

    /// The parameter PREFIX.NAME.
    template <class T, hal_param_dir_t DIR>
    void param(Param<T, DIR> &param, const char *name, std::type_identity_t<T> start = T{}) noexcept {
        char full[NAME_SIZE];
        param = start;
        if (isNamed(full, name)) {
            keep(hal_param_new(full, type_of<T>(), DIR, const_cast<T *>(&param.value_), comp_id_));
        }
    }

    /// The function PREFIX.NAME (only PREFIX without a name), which calls METHOD, a noexcept member that
    /// takes nothing or the period [ns].
    template <auto METHOD, class Self>
    void function(Self *self, const char *name = "") noexcept {
        char full[NAME_SIZE];
        if (isNamed(full, name)) {
            keep(hal_export_funct(full, &call<METHOD, Self>, self, 1, 0, comp_id_));
        }
    }

    /// Remembers a failure of a C API call made beside this class; true when `status` is none.
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
    static constexpr int EINVAL_ = 22;

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
            return keep(-EINVAL_);
        }
        return true;
    }

    int comp_id_;
    const char *prefix_;
    int index_;
    int status_ = 0;
};

/// Loads `count` instances (named `names[i]`, or COMPONENT.i where names are not given): the component id, or
/// a negated errno with nothing left behind. [while loading]
template <class T>
int load(const char *component, int count, char *const *names) noexcept {
    static_assert(std::is_trivially_destructible_v<T>, "instances are never destroyed");
    const int comp_id = hal_init(component);
    if (comp_id < 0) {
        return comp_id;
    }
    int status = 0;
    for (int i = 0; i < count && status == 0; ++i) {
        void *memory = hal_malloc(static_cast<long>(sizeof(T)));
        if (memory == nullptr) {
            status = -12;  // ENOMEM
            break;
        }
        T *instance = new (memory) T();
        char prefix[HAL_NAME_LEN + 1];
        const int length = names != nullptr ? rtapi_snprintf(prefix, sizeof prefix, "%s", names[i])
                                            : rtapi_snprintf(prefix, sizeof prefix, "%s.%d", component, i);
        if (length > HAL_NAME_LEN) {
            rtapi_print_msg(RTAPI_MSG_ERR, "%s: an instance name is longer than %d characters", component,
                            HAL_NAME_LEN);
            status = -22;  // EINVAL
            break;
        }
        Declare declare(comp_id, prefix, i);
        instance->declare(declare);
        status = declare.status();
    }
    if (status == 0) {
        status = hal_ready(comp_id);
    }
    if (status < 0) {
        hal_exit(comp_id);
        return status;
    }
    return comp_id;
}

/// How many instances count= and names= ask for: a number, or a negated errno when both are given or out of
/// range.
inline int instance_count(const char *component, int count, char *const *names, int max) noexcept {
    int named = 0;
    while (named < max && names[named] != nullptr && names[named][0] != '\0') {
        ++named;
    }
    if (named > 0 && count != 0) {
        rtapi_print_msg(RTAPI_MSG_ERR, "%s: give count= or names=, not both", component);
        return -22;  // EINVAL
    }
    if (count < 0 || count > max) {
        rtapi_print_msg(RTAPI_MSG_ERR, "%s: count=%d is out of range, 1 to %d instances are possible",
                        component, count, max);
        return -22;  // EINVAL
    }
    return named > 0 ? named : count > 0 ? count : 1;
}

}  // namespace mw::sdk

/// Defines the module: parameters COUNT_PARAM= (the number of instances) and names=, main and exit functions.
#define MW_COMPONENT_COUNTED(Type, component, max_instances, COUNT_PARAM)                                    \
    static int COUNT_PARAM = 0;                                                                              \
    RTAPI_MP_INT(COUNT_PARAM, "number of instances");                                                        \
    static char *names[max_instances];                                                                       \
    RTAPI_MP_ARRAY_STRING(names, max_instances, "names of instances");                                       \
    static int mw_comp_id = -1;                                                                              \
    int rtapi_app_main(void) {                                                                               \
        const int wanted = mw::sdk::instance_count(component, COUNT_PARAM, names, max_instances);            \
        const bool isNamed = names[0] != nullptr && names[0][0] != '\0';                                     \
        mw_comp_id =                                                                                         \
            wanted < 0 ? wanted : mw::sdk::load<Type>(component, wanted, isNamed ? names : nullptr);         \
        return mw_comp_id < 0 ? mw_comp_id : 0;                                                              \
    }                                                                                                        \
    void rtapi_app_exit(void) {                                                                              \
        hal_exit(mw_comp_id);                                                                                \
    }                                                                                                        \
    static_assert(true)

/// As above with count=. Components with other module parameters define rtapi_app_main themselves and use
/// load().
#define MW_COMPONENT(Type, component, max_instances)                                                         \
    MW_COMPONENT_COUNTED(Type, component, max_instances, count)

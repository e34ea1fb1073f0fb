// SPDX-License-Identifier: GPL-2.0-or-later
// Loading of modules: instances counted or named by module parameters, functions over all channels, and the
// main and exit functions.
#pragma once

#include <cerrno>
#include <new>
#include <type_traits>

#include "declare.hh"

namespace mw::sdk {

/// Maximum number of instances of a component without a lower limit.
constexpr int MANY = 1024;

/// Values of the module parameters.
struct Request {
    const char *module;      ///< name of the module, as in loadrt
    const char *count_name;  ///< "count" or "num_chan"
    int count;               ///< 0: not set
    char *const *names;      ///< null-terminated unless all `max` names are set
    int fallback;            ///< number of instances when neither is set
    int max;
    const char *prefix = nullptr;  ///< prefix of pins, if it is not the module's name

    bool isNamed() const noexcept { return names[0] != nullptr && names[0][0] != '\0'; }
};

/// The number of instances, or a negated errno with a message in the log.
inline int instance_count(const Request &request) noexcept {
    int named = 0;
    while (named < request.max && request.names[named] != nullptr && request.names[named][0] != '\0') {
        ++named;
    }
    if (named > 0 && request.count != 0) {
        rtapi_print_msg(RTAPI_MSG_ERR, "%s: give %s= or names=, not both", request.module,
                        request.count_name);
        return -EINVAL;
    }
    if (request.count < 0 || request.count > request.max) {
        rtapi_print_msg(RTAPI_MSG_ERR, "%s: %s=%d is out of range, 1 to %d are possible", request.module,
                        request.count_name, request.count, request.max);
        return -EINVAL;
    }
    return named > 0 ? named : (request.count > 0 ? request.count : request.fallback);
}

/// A HAL name in a fixed buffer.
struct Name {
    char text[HAL_NAME_LEN + 1] = {};

    /// MODULE with '-' for '_'.
    static Name of_module(const char *module) noexcept {
        Name name;
        rtapi_snprintf(name.text, sizeof name.text, "%s", module);
        for (char *c = name.text; *c != '\0'; ++c) {
            *c = *c == '_' ? '-' : *c;
        }
        return name;
    }
};

/// The prefix of instance `i`: its name, or MODULE.i. False, with a message, when it is too long.
inline bool make_prefix(Name &out, const Request &request, int i) noexcept {
    const int length =
        request.isNamed()
            ? rtapi_snprintf(out.text, sizeof out.text, "%s", request.names[i])
            : rtapi_snprintf(
                  out.text, sizeof out.text, "%s.%d",
                  Name::of_module(request.prefix != nullptr ? request.prefix : request.module).text, i);
    if (length > HAL_NAME_LEN) {
        rtapi_print_msg(RTAPI_MSG_ERR, "%s: an instance name is longer than %d characters", request.module,
                        HAL_NAME_LEN);
        return false;
    }
    return true;
}

/// A new T in HAL memory, or null.
template <class T>
T *make() noexcept {
    static_assert(std::is_trivially_destructible_v<T>, "instances are never destroyed");
    void *memory = hal_malloc(static_cast<long>(sizeof(T)));
    return memory == nullptr ? nullptr : new (memory) T();
}

/// Completes a load: the component becomes ready, or everything is undone. Returns the component id, or a
/// negated errno.
inline int finish(int comp_id, int status) noexcept {
    const int final_status = status == 0 ? hal_ready(comp_id) : status;
    if (final_status < 0) {
        hal_exit(comp_id);
        return final_status;
    }
    return comp_id;
}

/// Creates instance `i` with its declarations: 0, or a negated errno.
template <class T>
int make_instance(int comp_id, const Request &request, int i, T *&out) noexcept {
    out = make<T>();
    if (out == nullptr) {
        return -ENOMEM;
    }
    Name prefix;
    if (!make_prefix(prefix, request, i)) {
        return -EINVAL;
    }
    Declare declare(comp_id, prefix.text, i);
    out->declare(declare);
    return declare.status();
}

/// Loads separate instances of T, each with its own functions.
template <class T>
int load_instances(const Request &request) noexcept {
    const int count = instance_count(request);
    if (count < 0) {
        return count;
    }
    const int comp_id = hal_init(request.module);
    if (comp_id < 0) {
        return comp_id;
    }
    int status = 0;
    for (int i = 0; i < count && status == 0; ++i) {
        T *instance = nullptr;
        status = make_instance(comp_id, request, i, instance);
    }
    return finish(comp_id, status);
}

/// Loads one T, which creates all pins and functions of the module in `load(comp_id)` (0, or a negated
/// errno).
template <class T>
int load_single(const char *module) noexcept {
    const int comp_id = hal_init(module);
    if (comp_id < 0) {
        return comp_id;
    }
    T *all = make<T>();
    return finish(comp_id, all == nullptr ? -ENOMEM : all->load(comp_id));
}

/// As load_single, for a T with hardware: `end()` releases it when the load fails, and at the exit.
template <class T>
int load_device(const char *module, T *&device) noexcept {
    const int comp_id = hal_init(module);
    if (comp_id < 0) {
        return comp_id;
    }
    device = make<T>();
    const int status = device == nullptr ? -ENOMEM : device->load(comp_id);
    if (status < 0 && device != nullptr) {
        device->end();
    }
    return finish(comp_id, status);
}

/// Waits until `wanted_ns` after `begin_ns` (rtapi_get_time), at most a quarter of the period: for outputs
/// that are reset within the cycle. The clock of a simulation does not advance within a cycle; the wait ends
/// at once then. [servo or base thread]
inline void delay_after(long long begin_ns, std::uint32_t wanted_ns, long period_ns) noexcept {
    const long most_ns = period_ns / 4;
    const long delay_ns =
        wanted_ns < static_cast<std::uint32_t>(most_ns) ? static_cast<long>(wanted_ns) : most_ns;
    for (long waited_ns = 0; waited_ns < delay_ns; waited_ns += rtapi_delay_max()) {
        const long long rest_ns = begin_ns + delay_ns - rtapi_get_time();
        if (rest_ns <= 0) {
            return;
        }
        rtapi_delay(static_cast<long>(rest_ns));
    }
}

/// Channels that share module-wide functions.
template <class Channel, int MAX>
struct Channels {
    int count = 0;
    Channel *channel[MAX] = {};

    /// Creates the channels' pins: 0, or a negated errno.
    int make_channels(int comp_id, const Request &request, int wanted) noexcept {
        for (int i = 0; i < wanted; ++i) {
            if (const int status = make_instance(comp_id, request, i, channel[i]); status < 0) {
                return status;
            }
            ++count;
        }
        return 0;
    }
};

/// Loads a T with `Channels` as its base and `declare` for the module-wide functions (prefix MODULE).
template <class T>
int load_channels(const Request &request) noexcept {
    const int wanted = instance_count(request);
    if (wanted < 0) {
        return wanted;
    }
    const int comp_id = hal_init(request.module);
    if (comp_id < 0) {
        return comp_id;
    }
    T *all = make<T>();
    int status = all == nullptr ? -ENOMEM : all->make_channels(comp_id, request, wanted);
    if (status == 0) {
        const Name prefix = Name::of_module(request.module);
        Declare declare(comp_id, prefix.text, 0);
        all->declare(declare);
        status = declare.status();
    }
    return finish(comp_id, status);
}

}  // namespace mw::sdk

/// The module parameters COUNT= and names=, main and exit functions; LOAD is mw::sdk::load_instances<T> or
/// mw::sdk::load_channels<T>.
#define MW_MODULE(module, COUNT, fallback, max, LOAD)                                                        \
    static int COUNT = 0;                                                                                    \
    RTAPI_MP_INT(COUNT, "number of instances");                                                              \
    static char *names[max];                                                                                 \
    RTAPI_MP_ARRAY_STRING(names, max, "names of instances");                                                 \
    static int mw_comp_id = -1;                                                                              \
    int rtapi_app_main(void) {                                                                               \
        mw_comp_id = LOAD({module, #COUNT, COUNT, names, fallback, max});                                    \
        return mw_comp_id < 0 ? mw_comp_id : 0;                                                              \
    }                                                                                                        \
    void rtapi_app_exit(void) {                                                                              \
        hal_exit(mw_comp_id);                                                                                \
    }                                                                                                        \
    static_assert(true)

/// A component with count= (at most `max`) and names=, one instance by default.
#define MW_COMPONENT(Type, module, max) MW_MODULE(module, count, 1, max, mw::sdk::load_instances<Type>)

/// A module with its own parameters instead of count= and names=; see load_single.
#define MW_COMPONENT_SINGLE(Type, module)                                                                    \
    static int mw_comp_id = -1;                                                                              \
    int rtapi_app_main(void) {                                                                               \
        mw_comp_id = mw::sdk::load_single<Type>(module);                                                     \
        return mw_comp_id < 0 ? mw_comp_id : 0;                                                              \
    }                                                                                                        \
    void rtapi_app_exit(void) {                                                                              \
        hal_exit(mw_comp_id);                                                                                \
    }                                                                                                        \
    static_assert(true)

/// As MW_COMPONENT_SINGLE, for a device; see load_device. At the exit no function runs when `end()` is
/// called.
#define MW_COMPONENT_DEVICE(Type, module)                                                                    \
    static int mw_comp_id = -1;                                                                              \
    static Type *mw_device = nullptr;                                                                        \
    int rtapi_app_main(void) {                                                                               \
        mw_comp_id = mw::sdk::load_device<Type>(module, mw_device);                                          \
        return mw_comp_id < 0 ? mw_comp_id : 0;                                                              \
    }                                                                                                        \
    void rtapi_app_exit(void) {                                                                              \
        hal_exit(mw_comp_id);                                                                                \
        mw_device->end();                                                                                    \
    }                                                                                                        \
    static_assert(true)

/// personality= with one number for each instance.
#define MW_PERSONALITY(what)                                                                                 \
    static int personality[mw::sdk::MANY];                                                                   \
    RTAPI_MP_ARRAY_INT(personality, mw::sdk::MANY, what)

// SPDX-License-Identifier: GPL-2.0-or-later
// rtapi.h, rtapi_string.h and millwright_ext.h over the C++ view.
#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <cstring>

#include "hal/capi/status.hh"
#include "hal/core/loader.hh"
#include "hal/include/millwright_ext.h"
#include "hal/include/rtapi_string.h"
#include "runtime/format.hh"

using namespace mw::hal;
using namespace mw::hal::capi;
using mw::runtime::LogLevel;

namespace {

// The C API has one handler per process, for all instances.
std::atomic<rtapi_msg_handler_t> message_handler{nullptr};
std::atomic<int> last_module_id{0};

void print_message(LogLevel level, bool always, const char *format, std::va_list args) noexcept {
    if (rtapi_msg_handler_t handler = message_handler.load(std::memory_order_acquire)) {
        handler(static_cast<msg_level_t>(level), format, args);
    } else if (always) {
        current_log().vprint_always(level, format, args);
    } else {
        current_log().vprint(level, format, args);
    }
}

}  // namespace

extern "C" {

int rtapi_init(const char *modname) {
    return modname == nullptr ? -EINVAL : last_module_id.fetch_add(1) + 1;
}

int rtapi_exit(int module_id) {
    return module_id < 1 ? -EINVAL : 0;
}

rtapi_realtime_type_t rtapi_get_realtime_type(void) {
    return rtapi_is_realtime() != 0 ? REALTIME_TYPE_PREEMPT_RT : REALTIME_TYPE_NONE;
}

int rtapi_is_realtime(void) {
    Instance *hal = current();
    return hal != nullptr && !hal->isVirtual() && hal->host_status().isRealtime() ? 1 : 0;
}

int rtapi_is_kernelspace(void) {
    return 0;
}

int rtapi_vsnprintf(char *buf, unsigned long size, const char *fmt, va_list ap) {
    return mw::runtime::format_text(buf, size, fmt, ap);
}

int rtapi_snprintf(char *buf, unsigned long size, const char *fmt, ...) {
    va_list args;
    va_start(args, fmt);
    const int length = mw::runtime::format_text(buf, size, fmt, args);
    va_end(args);
    return length;
}

void rtapi_print(const char *fmt, ...) {
    va_list args;
    va_start(args, fmt);
    print_message(LogLevel::ALL, true, fmt, args);
    va_end(args);
}

void rtapi_print_msg(msg_level_t level, const char *fmt, ...) {
    if (level > rtapi_get_msg_level() || level == RTAPI_MSG_NONE) {
        return;
    }
    va_list args;
    va_start(args, fmt);
    print_message(static_cast<LogLevel>(level), false, fmt, args);
    va_end(args);
}

int rtapi_set_msg_level(int level) {
    if (level < RTAPI_MSG_NONE || level > RTAPI_MSG_ALL) {
        return -EINVAL;
    }
    current_log().set_level(static_cast<LogLevel>(level));
    return 0;
}

int rtapi_get_msg_level(void) {
    return static_cast<int>(current_log().level());
}

void rtapi_set_msg_handler(rtapi_msg_handler_t handler) {
    message_handler.store(handler, std::memory_order_release);
}

rtapi_msg_handler_t rtapi_get_msg_handler(void) {
    return message_handler.load(std::memory_order_acquire);
}

long long int rtapi_get_time(void) {
    const Instance *hal = current();
    return hal == nullptr ? 0 : hal->now_ns();
}

long long int rtapi_get_clocks(void) {
#if defined(__x86_64__) || defined(__i386__)
    const Instance *hal = current();
    if (hal == nullptr || !hal->isVirtual()) {
        return static_cast<long long>(__builtin_ia32_rdtsc());
    }
#endif
    return rtapi_get_time();
}

long int rtapi_delay_max(void) {
    return 10000;
}

void rtapi_delay(long int nsec) {
    const Instance *hal = current();
    if (hal == nullptr || hal->isVirtual()) {
        return;
    }
    const std::int64_t end = hal->now_ns() + std::min(nsec, rtapi_delay_max());
    while (hal->now_ns() < end) {
    }
}

long int rtapi_clock_set_period(long int nsecs) {
    return nsecs;
}

long simple_strtol(const char *nptr, char **endptr, int base) {
    return std::strtol(nptr, endptr, base);
}

int rtapi_shmem_new(int key, int /*module_id*/, unsigned long int size) {
    return with_hal([&](Instance &hal) {
        const auto block = hal.memory().open_block(key, size);
        return block ? block->id : complain(block.error());
    });
}

int rtapi_shmem_getptr(int shmem_id, void **ptr) {
    Instance *hal = current();
    if (hal == nullptr || shmem_id <= 0) {
        return -EINVAL;
    }
    *ptr = hal->memory().block_memory(shmem_id);
    return 0;
}

int rtapi_shmem_delete(int shmem_id, int /*module_id*/) {
    return with_hal([&](Instance &hal) { return hal.memory().close_block(shmem_id) ? 0 : -EINVAL; });
}

void rtapi_mp_register(const struct rtapi_mp_info *info) {
    Loader::add_parameter(info);
}

// ---- rtapi_string.h

size_t rtapi_strlcpy(char *dst, const char *src, size_t size) {
    const size_t length = std::strlen(src);
    if (size > 0) {
        const size_t copied = std::min(length, size - 1);
        std::memcpy(dst, src, copied);
        dst[copied] = '\0';
    }
    return length;
}

size_t rtapi_strlcat(char *dst, const char *src, size_t size) {
    const size_t start = ::strnlen(dst, size);
    return start == size ? size + std::strlen(src) : start + rtapi_strlcpy(dst + start, src, size - start);
}

char **rtapi_argv_split(rtapi_gfp_t /*flags*/, const char *argstr, int *argc) {
    // One block of memory: the vector, then the words to which it points.
    const size_t length = std::strlen(argstr);
    const size_t most = length / 2 + 2;
    char **argv = static_cast<char **>(std::malloc(most * sizeof(char *) + length + 1));
    if (argv == nullptr) {
        return nullptr;
    }
    char *text = reinterpret_cast<char *>(argv + most);
    std::memcpy(text, argstr, length + 1);
    int count = 0;
    char *rest = nullptr;
    for (char *word = ::strtok_r(text, " \t\n", &rest); word != nullptr;
         word = ::strtok_r(nullptr, " \t\n", &rest)) {
        argv[count++] = word;
    }
    argv[count] = nullptr;
    if (argc != nullptr) {
        *argc = count;
    }
    return argv;
}

void rtapi_argv_free(char **argv) {
    std::free(argv);
}

// ---- millwright_ext.h

void *mw_ext_find_symbol(const char *name) {
    Instance *hal = current();
    return hal == nullptr || hal->loader() == nullptr ? nullptr : hal->loader()->find_symbol(name);
}

int mw_ext_use_module(const char *symbol, int comp_id) {
    return with_hal([&](Instance &hal) {
        return hal.loader() == nullptr ? -ENOENT : status_of(hal.loader()->use(symbol, comp_id));
    });
}

int mw_ext_planner_new(const char *name, long long period_ns, void (*function)(void *, long long),
                       void *arg) {
    return with_hal([&](Instance &hal) {
        const auto id = hal.planners().create(name, period_ns, {function, arg});
        return id ? *id : complain(id.error());
    });
}

int mw_ext_planner_delete(int id) {
    return with_hal([&](Instance &hal) { return hal.planners().remove(id) ? 0 : -EINVAL; });
}

int mw_ext_pin_safe_value(const char *pin_name, const void *value) {
    return with_hal([&](Instance &hal) {
        const auto info = hal.pins().find(pin_name);
        if (!info) {
            return complain(info.error());
        }
        Value safe{info->type, 0};
        const bool wide = info->type == Type::FLOAT || info->type == Type::S64 || info->type == Type::U64;
        std::memcpy(&safe.bits, value, info->type == Type::BIT ? 1 : wide ? 8 : 4);
        return status_of(hal.pins().set_safe_value(pin_name, safe));
    });
}

int mw_ext_watch_controller(rtapi_u32 *is_gone, const rtapi_u32 *is_safe, int comp_id) {
    return with_hal([&](Instance &hal) {
        if (!hal.isHost() || is_gone == nullptr || is_safe == nullptr) {
            return complain(EINVAL, "only a realtime module can watch the controlling process");
        }
        hal.controller_watches().add(is_gone, is_safe, comp_id);
        return 0;
    });
}

int mw_ext_count_looks(rtapi_u32 *looks, int comp_id) {
    return with_hal([&](Instance &hal) {
        return hal.controller_watches().count_checks(comp_id, looks)
                   ? 0
                   : complain(EINVAL, "the component does not watch the controlling process");
    });
}

long long mw_ext_thread_period(const char *name) {
    Instance *hal = current();
    if (hal == nullptr || name == nullptr) {
        return 0;
    }
    for (const ThreadInfo &thread : hal->threads().list()) {
        if (thread.name == name) {
            return thread.period_ns;
        }
    }
    return 0;
}

static_assert(sizeof(std::atomic<std::uint32_t>) == sizeof(rtapi_u32));

const rtapi_u32 *mw_ext_links(void) {
    Instance *hal = current();
    return hal != nullptr ? reinterpret_cast<const rtapi_u32 *>(&hal->pins().link_changes()) : nullptr;
}

rtapi_u32 *mw_ext_lost_positions(void) {
    Instance *hal = current();
    return hal != nullptr ? reinterpret_cast<rtapi_u32 *>(&hal->host_status().lost_positions()) : nullptr;
}

int mw_ext_is_virtual(void) {
    const Instance *hal = current();
    return hal != nullptr && hal->isVirtual() ? 1 : 0;
}

}  // extern "C"

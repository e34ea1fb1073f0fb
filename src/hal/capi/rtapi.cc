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
using namespace mw::hal::detail;
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

void run_planner(void *argument, std::int64_t period_ns) {
    const auto *planner = static_cast<const PlannerRunner *>(argument);
    const UseInstance use(planner->hal);
    context().doing = "the planner of a module";
    planner->function(planner->argument, period_ns);
    context().doing = nullptr;
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
    const Hal *hal = current();
    return hal != nullptr && !hal->isVirtual() && hal->isRealtime() ? 1 : 0;
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
    const Hal *hal = current();
    return hal == nullptr ? 0 : hal->now_ns();
}

long long int rtapi_get_clocks(void) {
#if defined(__x86_64__) || defined(__i386__)
    const Hal *hal = current();
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
    const Hal *hal = current();
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
    return with_hal([&](Hal &hal) {
        Guard guard(hal.impl());
        const auto block = hal.impl().open_block(key, size);
        return block ? static_cast<int>(hal.impl().segment.offset_of(*block)) : complain(block.error());
    });
}

int rtapi_shmem_getptr(int shmem_id, void **ptr) {
    Hal *hal = current();
    if (hal == nullptr || shmem_id <= 0) {
        return -EINVAL;
    }
    const auto *block = hal->impl().segment.at<BlockRecord>(static_cast<Offset>(shmem_id));
    *ptr = hal->impl().segment.at<void>(block->memory);
    return 0;
}

int rtapi_shmem_delete(int shmem_id, int /*module_id*/) {
    return with_hal([&](Hal &hal) {
        Guard guard(hal.impl());
        auto *block = hal.impl().segment.at<BlockRecord>(static_cast<Offset>(shmem_id));
        if (shmem_id <= 0 || block->users == 0) {
            return -EINVAL;
        }
        --block->users;
        return 0;
    });
}

void rtapi_mp_register(const struct rtapi_mp_info *info) {
    // For programs and libraries that include the macros without being loaded as modules there is no
    // receiver.
    if (auto *parameters = context().parameters) {
        parameters->push_back(info);
    }
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
    // One block: the vector, then the words that it refers to.
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
    const Hal *hal = current();
    return hal == nullptr || hal->impl().loader == nullptr ? nullptr : hal->impl().loader->find_symbol(name);
}

int mw_ext_use_module(const char *symbol, int comp_id) {
    return with_hal([&](Hal &hal) {
        if (hal.impl().loader == nullptr) {
            return -ENOENT;
        }
        return status_of(hal.impl().loader->use(symbol, comp_id));
    });
}

int mw_ext_planner_new(const char *name, long long period_ns, void (*function)(void *, long long),
                       void *arg) {
    return with_hal([&](Hal &hal) {
        Guard guard(hal.impl());
        if (hal.scheduler() == nullptr) {
            return complain(EINVAL, "planners can only be made in the realtime process");
        }
        auto runner = std::make_unique<PlannerRunner>();
        runner->hal = &hal;
        runner->function = function;
        runner->argument = arg;
        mw::runtime::PeriodicSpec spec;
        spec.name = name;
        spec.period_ns = period_ns;
        spec.order = mw::runtime::Order::PLANNER;
        spec.function = &run_planner;
        spec.argument = runner.get();
        const auto periodic = hal.scheduler()->add(spec);
        if (!periodic) {
            return complain(periodic.error());
        }
        runner->periodic = *periodic;
        runner->id = ++hal.impl().last_planner_id;
        hal.impl().planners.push_back(std::move(runner));
        return hal.impl().last_planner_id;
    });
}

int mw_ext_planner_delete(int id) {
    return with_hal([&](Hal &hal) {
        Guard guard(hal.impl());
        auto &planners = hal.impl().planners;
        const auto found = std::find_if(planners.begin(), planners.end(),
                                        [id](const auto &planner) { return planner->id == id; });
        if (found == planners.end()) {
            return -EINVAL;
        }
        hal.scheduler()->remove((*found)->periodic);
        planners.erase(found);
        return 0;
    });
}

int mw_ext_pin_safe_value(const char *pin_name, const void *value) {
    return with_hal([&](Hal &hal) {
        const auto info = hal.pin(pin_name);
        if (!info) {
            return complain(info.error());
        }
        Value safe{info->type, 0};
        const bool wide = info->type == Type::FLOAT || info->type == Type::S64 || info->type == Type::U64;
        std::memcpy(&safe.bits, value, info->type == Type::BIT ? 1 : wide ? 8 : 4);
        return status_of(hal.set_safe_value(pin_name, safe));
    });
}

int mw_ext_watch_controller(rtapi_u32 *is_gone, const rtapi_u32 *is_safe, int comp_id) {
    return with_hal([&](Hal &hal) {
        if (!hal.isHost() || is_gone == nullptr || is_safe == nullptr) {
            return complain(EINVAL, "only a realtime module can watch the controlling process");
        }
        hal.impl().controller_watches.push_back({is_gone, is_safe, comp_id});
        return 0;
    });
}

int mw_ext_count_looks(rtapi_u32 *looks, int comp_id) {
    return with_hal([&](Hal &hal) {
        for (detail::ControllerWatch &watch : hal.impl().controller_watches) {
            if (watch.comp_id == comp_id) {
                watch.looks = looks;
                return 0;
            }
        }
        return complain(EINVAL, "the component does not watch the controlling process");
    });
}

long long mw_ext_thread_period(const char *name) {
    const Hal *hal = current();
    if (hal == nullptr || name == nullptr) {
        return 0;
    }
    for (const ThreadInfo &thread : hal->threads()) {
        if (thread.name == name) {
            return thread.period_ns;
        }
    }
    return 0;
}

const rtapi_u32 *mw_ext_links(void) {
    static_assert(sizeof(Header::links) == sizeof(rtapi_u32));
    Hal *hal = current();
    return hal != nullptr ? reinterpret_cast<const rtapi_u32 *>(&hal->impl().segment.header().links)
                          : nullptr;
}

rtapi_u32 *mw_ext_lost_positions(void) {
    static_assert(sizeof(Header::lost_positions) == sizeof(rtapi_u32));
    Hal *hal = current();
    return hal != nullptr ? reinterpret_cast<rtapi_u32 *>(&hal->impl().segment.header().lost_positions)
                          : nullptr;
}

int mw_ext_is_virtual(void) {
    const Hal *hal = current();
    return hal != nullptr && hal->isVirtual() ? 1 : 0;
}

}  // extern "C"

// SPDX-License-Identifier: GPL-2.0-or-later
// hal.h: components, signals, functions, threads.
#include <cstdarg>
#include <cstring>
#include <memory>
#include <mutex>

#include "hal/capi/status.hh"
#include "hal/core/loader.hh"
#include "runtime/format.hh"

namespace mw::hal::capi {

runtime::Log &current_log() noexcept {
    Instance *hal = current();
    if (hal != nullptr) {
        return hal->log();
    }
    // For messages before an instance is joined; never destroyed, because threads may print while the process
    // ends.
    static auto *process_log = new runtime::Log;
    return *process_log;
}

int complain(int code, const std::string &message) noexcept {
    current_log().print(runtime::LogLevel::ERR, "HAL: %s", message.c_str());
    return -code;
}

int complain(const Error &error) noexcept {
    const int code = errno > 0 ? errno : EINVAL;
    return complain(code, error.str());
}

int status_of(const Result<> &result) noexcept {
    return result ? 0 : complain(result.error());
}

namespace {

/// The instance that hal_init has joined for a program without its own instance.
struct ProcessAttachment {
    std::mutex mutex;
    std::unique_ptr<Instance> hal;
    int users = 0;
};

ProcessAttachment &attachment() {
    // Never destroyed: components may still call hal_exit while the process ends.
    static auto *the_attachment = new ProcessAttachment;
    return *the_attachment;
}

/// The current instance; joins the instance of the environment if the process has none. Each call of joined()
/// needs a leave().
Instance *joined() {
    ProcessAttachment &here = attachment();
    const std::lock_guard lock(here.mutex);
    Instance *own = current();
    if (own != nullptr && own != here.hal.get()) {
        return own;
    }
    if (here.hal == nullptr) {
        auto attached = Instance::attach(default_instance());
        if (!attached) {
            complain(attached.error());
            return nullptr;
        }
        here.hal = std::move(*attached);
        set_process_instance(here.hal.get());
    }
    ++here.users;
    return here.hal.get();
}

void leave(const Instance *hal) {
    ProcessAttachment &here = attachment();
    const std::lock_guard lock(here.mutex);
    const bool is_user = here.hal.get() == hal && here.users > 0;
    here.users -= is_user ? 1 : 0;
    if (is_user && here.users == 0) {
        here.hal.reset();
    }
}

template <class Info>
int hand_out(Instance &hal, const Result<Info> &info, hal_type_t *type, hal_data_u **data) {
    if (!info) {
        return -ENOENT;
    }
    const auto address = hal.values().address_of(info->name, info->type);
    if (!address) {
        return -ENOENT;
    }
    *type = static_cast<hal_type_t>(info->type);
    *data = static_cast<hal_data_u *>(const_cast<void *>(*address));
    return 0;
}

}  // namespace
}  // namespace mw::hal::capi

using namespace mw;
using namespace mw::hal;
using namespace mw::hal::capi;

extern "C" {

int hal_init(const char *name) {
    Instance *hal = joined();
    if (hal == nullptr) {
        return -ENOENT;
    }
    const auto id = hal->components().create(name == nullptr ? "" : name,
                                             Loader::isLoading() ? CompType::REALTIME : CompType::USER);
    if (!id) {
        const int status = complain(id.error());
        leave(hal);
        return status;
    }
    return *id;
}

int hal_exit(int comp_id) {
    Instance *hal = current();
    if (hal == nullptr) {
        return -EINVAL;
    }
    const int status = status_of(hal->components().remove(comp_id));
    leave(hal);
    return status;
}

int hal_lib_init(void) {
    return joined() == nullptr ? -ENOENT : 0;
}

void hal_lib_exit(void) {
    if (Instance *hal = current()) {
        leave(hal);
    }
}

int hal_ready(int comp_id) {
    return with_hal([&](Instance &hal) { return hal.components().set_ready(comp_id, true); });
}

int hal_unready(int comp_id) {
    return with_hal([&](Instance &hal) { return hal.components().set_ready(comp_id, false); });
}

int hal_set_unready(int comp_id) {
    return hal_unready(comp_id);
}

char *hal_comp_name(int comp_id) {
    Instance *hal = current();
    return hal == nullptr ? nullptr : hal->components().stored_name(comp_id);
}

int hal_is_init(void) {
    return current() != nullptr ? 1 : 0;
}

void *hal_malloc(long int size) {
    Instance *hal = current();
    return hal == nullptr || size < 0 ? nullptr : hal->memory().allocate(static_cast<std::size_t>(size));
}

const char *hal_strerror(int err) {
    return ::strerrordesc_np(err < 0 ? -err : err);
}

// ---- signals and values

int hal_signal_new(const char *name, hal_type_t type) {
    return with_hal([&](Instance &hal) { return hal.signals().create(name, static_cast<Type>(type)); });
}

int hal_signal_delete(const char *name) {
    return with_hal([&](Instance &hal) { return hal.signals().remove(name); });
}

int hal_link(const char *pin_name, const char *sig_name) {
    return with_hal([&](Instance &hal) { return hal.signals().link(pin_name, sig_name); });
}

int hal_unlink(const char *pin_name) {
    return with_hal([&](Instance &hal) { return hal.signals().unlink(pin_name); });
}

int hal_pin_alias(const char *pin_name, const char *alias) {
    return with_hal(
        [&](Instance &hal) { return hal.pins().set_alias(pin_name, alias == nullptr ? "" : alias); });
}

int hal_param_alias(const char *param_name, const char *alias) {
    return with_hal(
        [&](Instance &hal) { return hal.params().set_alias(param_name, alias == nullptr ? "" : alias); });
}

int hal_get_pin_value_by_name(const char *name, hal_type_t *type, hal_data_u **data, bool *connected) {
    return with_hal([&](Instance &hal) {
        const auto info = hal.pins().find(name);
        if (info && connected != nullptr) {
            *connected = !info->signal.empty();
        }
        return hand_out(hal, info, type, data);
    });
}

int hal_get_signal_value_by_name(const char *name, hal_type_t *type, hal_data_u **data, bool *has_writers) {
    return with_hal([&](Instance &hal) {
        const auto info = hal.signals().find(name);
        if (info && has_writers != nullptr) {
            *has_writers = info->writers > 0;
        }
        return hand_out(hal, info, type, data);
    });
}

int hal_get_param_value_by_name(const char *name, hal_type_t *type, hal_data_u **data) {
    return with_hal([&](Instance &hal) { return hand_out(hal, hal.params().find(name), type, data); });
}

// ---- functions and threads

int hal_export_funct(const char *name, void (*funct)(void *, long), void *arg, int uses_fp, int reentrant,
                     int comp_id) {
    return with_hal([&](Instance &hal) {
        return hal.functions().create(name, {funct, arg, reentrant != 0, uses_fp != 0}, comp_id);
    });
}

int hal_export_functf(void (*funct)(void *, long), void *arg, int uses_fp, int reentrant, int comp_id,
                      const char *fmt, ...) {
    char name[NAME_LENGTH + 2];
    std::va_list args;
    va_start(args, fmt);
    const int length = runtime::format_text(name, sizeof name, fmt, args);
    va_end(args);
    if (length > static_cast<int>(NAME_LENGTH)) {
        return complain(EINVAL, fmt::format("function name '{}...' has {} characters, at most {} are allowed",
                                            name, length, NAME_LENGTH));
    }
    return hal_export_funct(name, funct, arg, uses_fp, reentrant, comp_id);
}

int hal_create_thread(const char *name, unsigned long period_nsec, int /*uses_fp*/) {
    return with_hal(
        [&](Instance &hal) { return hal.threads().create(name, static_cast<std::int64_t>(period_nsec)); });
}

int hal_thread_delete(const char *name) {
    return with_hal([&](Instance &hal) { return hal.threads().remove(name); });
}

int hal_add_funct_to_thread(const char *funct_name, const char *thread_name, int position) {
    return with_hal(
        [&](Instance &hal) { return hal.threads().add_function(funct_name, thread_name, position); });
}

int hal_init_funct_to_thread(const char *funct_name, const char *thread_name, int position) {
    return with_hal(
        [&](Instance &hal) { return hal.threads().add_init_function(funct_name, thread_name, position); });
}

int hal_del_funct_from_thread(const char *funct_name, const char *thread_name) {
    return with_hal([&](Instance &hal) { return hal.threads().remove_function(funct_name, thread_name); });
}

int hal_start_threads(void) {
    return with_hal([&](Instance &hal) { return hal.threads().start(); });
}

int hal_stop_threads(void) {
    return with_hal([&](Instance &hal) { return hal.threads().stop(); });
}

int hal_set_lock(unsigned char lock_type) {
    return with_hal([&](Instance &hal) { return hal.set_lock(lock_type); });
}

unsigned char hal_get_lock(void) {
    Instance *hal = current();
    return hal == nullptr ? 0 : hal->lock();
}

}  // extern "C"

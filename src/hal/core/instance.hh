// SPDX-License-Identifier: GPL-2.0-or-later
// One HAL instance as seen by this process, and its registries by role. Names are unique per type, at most
// 127 characters. Methods are not realtime-safe and may be called from any non-realtime thread and process
// concurrently, unless stated otherwise; failures also set errno for the C API.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

#include "base/result.hh"
#include "hal/core/components.hh"
#include "hal/core/controller_watches.hh"
#include "hal/core/functions.hh"
#include "hal/core/host_status.hh"
#include "hal/core/memory.hh"
#include "hal/core/params.hh"
#include "hal/core/pins.hh"
#include "hal/core/planners.hh"
#include "hal/core/processes.hh"
#include "hal/core/signals.hh"
#include "hal/core/threads.hh"
#include "hal/core/value.hh"
#include "hal/core/values.hh"
#include "runtime/log.hh"
#include "runtime/scheduler.hh"

namespace mw::hal {

class Loader;

/// Bits of the lock, as in hal.h.
enum Lock : std::uint8_t {
    LOCK_NONE = 0,
    LOCK_LOAD = 1,
    LOCK_CONFIG = 2,
    LOCK_PARAMS = 4,
    LOCK_RUN = 8,
    LOCK_TUNE = 3,
    LOCK_ALL = 255
};

struct InstanceOptions {
    std::string name = "default";
    bool isShared = false;  ///< in shared memory for other processes, or private to this process
    runtime::Scheduler *scheduler = nullptr;  ///< runs the threads; must outlive the instance
    runtime::Log *log = nullptr;              ///< must outlive the instance; null: a separate log on standard
                                              ///< error
};

class Instance {
  public:
    /// Creates the instance and becomes its realtime host. A shared instance replaces the remains of a dead
    /// host.
    static Result<std::unique_ptr<Instance>> create(const InstanceOptions &options);
    /// Joins a shared instance of this user; an error when it has no host or another version.
    static Result<std::unique_ptr<Instance>> attach(std::string_view name);
    ~Instance();
    Instance(const Instance &) = delete;
    Instance &operator=(const Instance &) = delete;

    const std::string &name() const noexcept { return name_; }
    bool isHost() const noexcept { return scheduler_ != nullptr; }
    runtime::Log &log() noexcept { return *log_; }
    /// The scheduler of the host; null in an attached process.
    runtime::Scheduler *scheduler() noexcept { return scheduler_; }
    /// True under the virtual clock. [any thread, realtime-safe]
    bool isVirtual() const noexcept;
    /// Time of rtapi_get_time: in the host from its scheduler, in other processes from the same clock. [any
    /// thread, realtime-safe]
    std::int64_t now_ns() const noexcept;
    Result<> set_lock(std::uint8_t lock);
    std::uint8_t lock() const noexcept;
    /// The host's loader of modules; null if there is none. The loader sets this pointer.
    Loader *loader() noexcept { return loader_; }
    void set_loader(Loader *loader) noexcept { loader_ = loader; }

    HostStatus &host_status() noexcept { return host_status_; }
    Memory &memory() noexcept { return memory_; }
    ControllerWatches &controller_watches() noexcept { return controller_watches_; }
    Components &components() noexcept { return components_; }
    Processes &processes() noexcept { return processes_; }
    Pins &pins() noexcept { return pins_; }
    Params &params() noexcept { return params_; }
    Signals &signals() noexcept { return signals_; }
    Values &values() noexcept { return values_; }
    Functions &functions() noexcept { return functions_; }
    Threads &threads() noexcept { return threads_; }
    Planners &planners() noexcept { return planners_; }

  private:
    Instance(const InstanceOptions &options, std::unique_ptr<detail::Segment> segment);

    std::string name_;
    std::unique_ptr<detail::Segment> segment_;
    runtime::Scheduler *scheduler_;
    std::unique_ptr<runtime::Log> own_log_;
    runtime::Log *log_;
    Loader *loader_ = nullptr;
    HostStatus host_status_;
    Memory memory_;
    ControllerWatches controller_watches_;
    Components components_;
    Processes processes_;
    Pins pins_;
    Params params_;
    Signals signals_;
    Values values_;
    Functions functions_;
    Threads threads_;
    Planners planners_;
};

/// The instance of the C API: this thread's override, else the process's, else null. [any thread,
/// realtime-safe]
Instance *current() noexcept;
/// Sets the process's instance; null removes it.
void set_process_instance(Instance *hal) noexcept;

/// Makes an instance the current one of this thread during its lifetime: for loading modules, and for tests
/// with two machines. [any thread, realtime-safe]
class UseInstance {
  public:
    explicit UseInstance(Instance *hal) noexcept;
    ~UseInstance();
    UseInstance(const UseInstance &) = delete;
    UseInstance &operator=(const UseInstance &) = delete;

  private:
    Instance *before_;
};

/// $MILLWRIGHT_INSTANCE, or "default". Instances of different users are separate.
std::string default_instance();

/// The name of an instance's shared memory.
std::string segment_name(std::string_view instance);

}  // namespace mw::hal

// SPDX-License-Identifier: GPL-2.0-or-later
// One HAL instance as seen by this process: pins, signals, parameters, functions, threads and components.
// Names are unique per type, at most 127 characters. Methods are not realtime-safe and may be called from any
// non-realtime thread and process concurrently, unless stated otherwise; failures also set errno for the C
// API.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.hh"
#include "hal/core/value.hh"
#include "runtime/log.hh"
#include "runtime/scheduler.hh"

namespace mw::hal {

inline constexpr std::size_t NAME_LENGTH = 127;

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

enum class CompType : std::int8_t { USER = 0, REALTIME = 1, OTHER = 2 };

struct PinInfo {
    std::string name;           ///< the alias if there is one
    std::string original_name;  ///< empty unless there is an alias
    Type type = Type::BIT;
    Dir dir = Dir::IN;
    int owner_id = 0;
    std::string owner;
    std::string signal;  ///< empty when not linked
    Value value;
};

struct ParamInfo {
    std::string name;
    std::string original_name;
    Type type = Type::BIT;
    Dir dir = Dir::RO;
    int owner_id = 0;
    std::string owner;
    Value value;
};

struct SignalPin {
    std::string name;
    Dir dir = Dir::IN;
};

struct SignalInfo {
    std::string name;
    Type type = Type::BIT;
    Value value;
    int readers = 0;
    int writers = 0;
    int bidirectionals = 0;
    std::vector<SignalPin> pins;  ///< sorted by name
};

struct FunctInfo {
    std::string name;
    int owner_id = 0;
    std::string owner;
    int users = 0;  ///< number of uses in threads
    bool reentrant = false;
    bool usesFloat = false;
    std::uint64_t address = 0;  ///< in the realtime process
    std::uint64_t argument = 0;
};

struct ThreadInfo {
    std::string name;
    std::int64_t period_ns = 0;
    int owner_id = 0;                         ///< of the pseudo component __NAME
    std::vector<std::string> init_functions;  ///< run once
    std::vector<std::string> functions;       ///< in order of execution
    std::uint64_t overruns = 0;               ///< releases skipped
    std::int64_t max_latency_ns = 0;          ///< of the wake-up
    std::int64_t time_ns = 0;
    std::int64_t tmax_ns = 0;
};

struct CompInfo {
    std::string name;
    int id = 0;
    CompType type = CompType::USER;
    bool isReady = false;
    int pid = 0;
    std::string insmod_args;  ///< of loadrt; empty for others
    bool is_loaded_by_loadrt = false;
};

/// A component that was removed because its process died without leaving HAL.
struct DeathInfo {
    std::string name;
    int pid = 0;
    std::int64_t time_ns = 0;  ///< time of detection, as now_ns() of a realtime host
};

struct RecordCount {
    int active = 0;
    int recycled = 0;  ///< removed records that will be reused
};

struct HalStatistics {
    std::size_t segment_bytes = 0;  ///< in use now
    std::size_t capacity_bytes = 0;
    RecordCount components, pins, aliases, signals, params, functs, threads;
};

struct HalOptions {
    std::string name = "default";  ///< of the instance
    bool isShared = false;         ///< in shared memory for other processes, or private to this process
    runtime::Scheduler *scheduler = nullptr;  ///< runs the threads; must outlive the instance
    runtime::Log *log = nullptr;              ///< must outlive the instance; null: a separate log to stderr
};

class Hal {
  public:
    /// Creates the instance and becomes its realtime host. A shared one replaces the remains of a dead host.
    static Result<std::unique_ptr<Hal>> create(const HalOptions &options);
    /// Joins a shared instance of this user; an error when it has no host or another version.
    static Result<std::unique_ptr<Hal>> attach(std::string_view instance);
    ~Hal();
    Hal(const Hal &) = delete;
    Hal &operator=(const Hal &) = delete;

    const std::string &name() const noexcept;
    bool isHost() const noexcept;
    bool isVirtual() const noexcept;
    /// True when the host's threads have realtime priority.
    bool isRealtime() const noexcept;
    /// Why they do not, as reported by the realtime process at its start; empty when they do, or in virtual
    /// time.
    std::string realtime_missing() const;
    void set_realtime_missing(std::string_view why);
    /// Why the realtime host has ended or is crashing; nothing otherwise.
    std::optional<std::string> host_end() const;
    runtime::Log &log() noexcept;
    /// The scheduler of the host; null in an attached process.
    runtime::Scheduler *scheduler() noexcept;
    /// rtapi_get_time: of the scheduler in the host, of the same clock elsewhere. [any thread, realtime-safe]
    std::int64_t now_ns() const noexcept;

    // ---- components
    /// Adds a component of this process; returns its id.
    Result<int> new_component(std::string_view name, CompType type = CompType::USER);
    Result<> set_ready(int comp_id, bool isReady = true);
    /// Removes a component: its functions leave the threads, and its pins, parameters and functions are
    /// removed.
    Result<> delete_component(int comp_id);
    /// Removes components whose process has ended, after setting their outputs to safe values. Returns their
    /// names. A process with threads counts as ended as soon as its first thread has ended, before its pidfd
    /// reports it.
    std::vector<std::string> reap_dead_components();
    /// The process of this component will be ended on request, which does not count as a death.
    Result<> expect_end(int comp_id);
    /// The last components (at most 16) whose process died, oldest first; without those that were restarted.
    std::vector<DeathInfo> deaths() const;
    Result<> set_insmod_args(int comp_id, std::string_view args);

    // ---- things of components
    /// 8-byte aligned zeroed memory of the instance; null when none is left.
    void *allocate(std::size_t bytes);
    /// `slot` must be in memory of allocate(); it points to the value from then on.
    Result<> new_pin(std::string_view name, Type type, Dir dir, void **slot, int comp_id);
    /// A pin with its own slot, for programs without a struct; read and write through the returned slot.
    Result<void **> new_pin(std::string_view name, Type type, Dir dir, int comp_id);
    /// `address` must be in memory of allocate().
    Result<> new_param(std::string_view name, Type type, Dir dir, void *address, int comp_id);
    Result<> new_funct(std::string_view name, void (*function)(void *, long), void *argument, int comp_id,
                       bool reentrant = false, bool usesFloat = true);
    Result<> set_safe_value(std::string_view pin, const Value &value);

    // ---- signals and links
    Result<> new_signal(std::string_view name, Type type);
    Result<> delete_signal(std::string_view name);
    Result<> link(std::string_view pin, std::string_view signal);
    Result<> unlink(std::string_view pin);
    /// As halcmd's net: creates the signal with the first pin's type unless it exists, and links every pin.
    /// Everything is checked first: a failure changes nothing.
    Result<> net(std::string_view signal, const std::vector<std::string> &pins);

    // ---- values
    Result<Value> get_pin(std::string_view name) const;
    Result<Value> get_signal(std::string_view name) const;
    Result<Value> get_param(std::string_view name) const;
    /// As getp: parameter or pin (parameter first).
    Result<Value> get(std::string_view name) const;
    /// As setp: rejects OUT pins, linked pins and RO parameters; parameter before pin of the same name.
    Result<> set(std::string_view name, const Value &value);
    Result<> set(std::string_view name, std::string_view text);
    /// As sets: rejected while the signal has a writer. The value of a port signal is the size of its buffer.
    Result<> set_signal(std::string_view name, const Value &value);
    Result<> set_signal(std::string_view name, std::string_view text);
    /// Sets the value of an IN or IO pin as if its signal had changed; for tests and simulations.
    Result<> force(std::string_view pin_or_signal, const Value &value);
    /// Current address of the value of a pin, parameter or signal, for programs that read often. That of a
    /// pin changes when it is linked or unlinked: use the slot for your own pins.
    Result<volatile void *> address_of(std::string_view name, Type type);

    // ---- aliases; an empty alias removes it
    Result<> alias_pin(std::string_view name, std::string_view alias);
    Result<> alias_param(std::string_view name, std::string_view alias);

    // ---- threads (new_thread, delete_thread: in the host only)
    Result<> new_thread(std::string_view name, std::int64_t period_ns, bool usesFloat = true);
    Result<> delete_thread(std::string_view name);
    /// Position 1 is the first, -1 the last.
    Result<> add_function(std::string_view function, std::string_view thread, int position = -1);
    /// The function runs once, in the next period of running threads, before the others.
    Result<> add_init_function(std::string_view function, std::string_view thread, int position = -1);
    Result<> remove_function(std::string_view function, std::string_view thread);
    Result<> start_threads();
    Result<> stop_threads();
    bool isRunning() const noexcept;
    /// Publishes overruns and latencies of the threads for other processes. [host]
    void publish_thread_figures();

    Result<> set_lock(std::uint8_t lock);
    std::uint8_t lock() const noexcept;

    // ---- queries: sorted by name; `glob` takes * ? [abc] and is matched with the name and the alias
    std::vector<PinInfo> pins(std::string_view glob = "*") const;
    std::vector<ParamInfo> params(std::string_view glob = "*") const;
    std::vector<SignalInfo> signals(std::string_view glob = "*") const;
    std::vector<FunctInfo> functs(std::string_view glob = "*") const;
    std::vector<ThreadInfo> threads(std::string_view glob = "*") const;  ///< shortest period first
    std::vector<CompInfo> components(std::string_view glob = "*") const;
    /// Fast queries by name (or alias); those below explain a failure with the nearest known name.
    bool hasPin(std::string_view name) const;
    bool hasParam(std::string_view name) const;
    bool hasSignal(std::string_view name) const;
    bool hasComponent(std::string_view name) const;
    Result<PinInfo> pin(std::string_view name) const;
    Result<ParamInfo> param(std::string_view name) const;
    Result<SignalInfo> signal(std::string_view name) const;
    Result<CompInfo> component(std::string_view name) const;
    Result<CompInfo> component(int comp_id) const;
    HalStatistics statistics() const;

    // ---- shared memory by key (rtapi_shmem_*), for channels between modules and programs
    /// The zeroed block of this key, the same for all callers in the instance. Valid until the instance ends.
    Result<void *> shared_block(int key, std::size_t bytes);

    struct Impl;
    Impl &impl() noexcept { return *impl_; }
    const Impl &impl() const noexcept { return *impl_; }

  private:
    explicit Hal(std::unique_ptr<Impl> impl);
    std::unique_ptr<Impl> impl_;
};

/// The instance of the C API: this thread's override, else the process's, else null. [any thread]
Hal *current() noexcept;
/// Sets the process's instance; null when it ends.
void set_process_instance(Hal *hal) noexcept;

/// Makes an instance the current one of this thread during its lifetime: for loading modules, and for tests
/// with two machines.
class UseInstance {
  public:
    explicit UseInstance(Hal *hal) noexcept;
    ~UseInstance();
    UseInstance(const UseInstance &) = delete;
    UseInstance &operator=(const UseInstance &) = delete;

  private:
    Hal *before_;
};

/// $MILLWRIGHT_INSTANCE, or "default". Instances of different users never meet.
std::string default_instance();

}  // namespace mw::hal

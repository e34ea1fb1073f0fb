// SPDX-License-Identifier: GPL-2.0-or-later
// Internals of Hal, shared by its source files only.
#pragma once

#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include "hal/core/detail/segment.hh"
#include "hal/core/detail/ticks.hh"
#include "hal/core/hal.hh"
#include "hal/include/rtapi.h"

namespace mw::hal {

class Loader;

namespace detail {

/// Calls a planner of mw_ext_planner_new, with its instance as the current one.
struct PlannerRunner {
    Hal *hal = nullptr;
    void (*function)(void *, long long) = nullptr;
    void *argument = nullptr;
    int id = 0;
    runtime::PeriodicId periodic;
};

/// A module that must know of the end of the controlling process, and reports when the machine is stopped.
struct ControllerWatch {
    std::uint32_t *is_gone;
    const std::uint32_t *is_safe;
    int comp_id;
    std::uint32_t *looks = nullptr;  ///< null: not requested
};

/// Runs one HAL thread in the host.
struct ThreadRunner {
    Hal::Impl *hal = nullptr;
    ThreadRecord *record = nullptr;
    runtime::PeriodicId periodic;
};

/// A failure with the code that the C API returns.
std::unexpected<Error> refuse(int code, std::string message, std::string hint = {});

}  // namespace detail

struct Hal::Impl {
    std::string name;
    Hal *self = nullptr;
    bool is_host = false;
    bool isShared = false;
    runtime::Scheduler *scheduler = nullptr;
    runtime::Log *log = nullptr;
    std::unique_ptr<runtime::Log> own_log;
    detail::Segment segment;
    Loader *loader = nullptr;                                      ///< the host's loader, if there is one
    std::vector<std::unique_ptr<detail::ThreadRunner>> runners;    ///< under the segment's lock
    std::vector<std::unique_ptr<detail::PlannerRunner>> planners;  ///< under the segment's lock
    int last_planner_id = 0;
    detail::TickCounter counter;                              ///< times the functions of threads
    std::vector<detail::ControllerWatch> controller_watches;  ///< in the host's thread
    /// Constructors of instances, by component id, for components of this process; under the segment's lock.
    std::map<int, int (*)(const char *, const char *)> constructors;

    // With the lock held:
    detail::CompRecord *find_comp(int id) const noexcept;
    detail::PinRecord *find_pin(std::string_view name) const noexcept;
    detail::ParamRecord *find_param(std::string_view name) const noexcept;
    detail::SignalRecord *find_signal(std::string_view name) const noexcept;
    Result<> check_name(detail::Kind kind, std::string_view name) const;
    Result<> check_lock(std::uint8_t lock, const char *what) const;
    /// "there is no pin 'x'", with the nearest name as the hint.
    std::unexpected<Error> no_such(detail::Kind kind, std::string_view name) const;
    Result<int> add_comp(std::string_view name, CompType type);
    Result<> add_pin(std::string_view name, Type type, Dir dir, void **slot, detail::CompRecord &comp);
    Result<> add_param(std::string_view name, Type type, Dir dir, void *address, detail::CompRecord &comp);
    Result<> check_link(const detail::PinRecord &pin, const detail::SignalRecord &signal) const;
    void link_pin(detail::PinRecord &pin, detail::SignalRecord &signal) noexcept;
    void unlink_pin(detail::PinRecord &pin) noexcept;
    Result<> make_queue(detail::SignalRecord &signal, std::uint32_t size);
    void remove_pin(detail::PinRecord &pin) noexcept;
    void remove_param(detail::ParamRecord &param) noexcept;
    void remove_funct(detail::FunctRecord &funct) noexcept;
    void remove_comp(detail::CompRecord &comp, bool dead) noexcept;
    void note_death(const detail::CompRecord &comp) noexcept;
    /// Keeps the components of this process until spare_process(0), also against reaping: the machine brakes
    /// through their outputs.
    void spare_process(std::int32_t pid);
    /// The process is stopped or hangs: its bit outputs take their safe values until it writes them again.
    void rest_process(std::int32_t pid);
    void point_slot(const detail::PinRecord &pin, detail::Offset value) noexcept;
    detail::Offset value_of(const detail::PinRecord &pin) const noexcept;
    template <class Change>
    Result<> change_list(detail::ThreadRecord &thread, Change change);
    void drop_from_lists(detail::Offset funct) noexcept;
    Result<> add_to_thread(std::string_view function, std::string_view thread, int position, bool is_init);
    Result<> remove_thread(detail::ThreadRecord &thread);
    /// Waits until the functions of the current cycle have ended.
    void wait_for_cycle(const detail::ThreadRecord &thread) const noexcept;
    Value read(Type type, detail::Offset value) const noexcept;
    void write(detail::Offset value, const Value &from) noexcept;
    std::string comp_name(detail::Offset comp) const;
    int comp_id(detail::Offset comp) const noexcept;
    /// The block of this key with one more user; zeroed for the first one.
    Result<detail::BlockRecord *> open_block(int key, std::size_t bytes);
    void publish_figures() const;
    /// Stores why this host ends; the first text is kept. [any thread, async-signal-safe]
    void note_end(const char *text) noexcept;
    void run_thread(detail::ThreadRecord &thread) noexcept;
    void run_timed(detail::ThreadRecord &thread, const detail::FunctionList &list,
                   std::uint32_t first) noexcept;
};

namespace detail {

/// The name of an instance's shared memory.
std::string segment_name(std::string_view instance);

/// Locks an instance during its lifetime. Reading needs the lock too.
class Guard {
  public:
    explicit Guard(const Hal::Impl &hal) noexcept : segment_(const_cast<Segment &>(hal.segment)) {
        segment_.lock();
    }
    ~Guard() { segment_.unlock(); }
    Guard(const Guard &) = delete;
    Guard &operator=(const Guard &) = delete;

  private:
    Segment &segment_;
};

/// State of this thread for the C API. No heap, so that a realtime thread may use it at once.
struct ThreadContext {
    Hal *instance = nullptr;               ///< overrides the process's instance
    bool realtime = false;                 ///< inside a HAL thread
    const char *loading = nullptr;         ///< name of the module being loaded
    const char *unloading = nullptr;       ///< name of the module being unloaded
    const char *doing = nullptr;           ///< other activity, for a crash report
    const ThreadRecord *thread = nullptr;  ///< current HAL thread
    const ListEntry *calling = nullptr;    ///< its current function
    std::vector<const rtapi_mp_info *> *parameters =
        nullptr;  ///< collects parameters of the module being loaded
};
ThreadContext &context() noexcept;

}  // namespace detail
}  // namespace mw::hal

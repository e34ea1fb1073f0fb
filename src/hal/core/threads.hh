// SPDX-License-Identifier: GPL-2.0-or-later
// The HAL threads of an instance and the order of their functions. Invariant: when a method that changes the
// order returns, no thread uses the old order. The methods are not realtime-safe, unless stated otherwise
// [any non-realtime thread and process]; the threads themselves are (detail/thread_runner.hh).
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.hh"
#include "runtime/scheduler.hh"

namespace mw::hal {

namespace detail {
class Segment;
class TickCounter;
struct ThreadRecord;
struct ThreadRunner;
}  // namespace detail
class Instance;

struct ThreadInfo {
    std::string name;
    std::int64_t period_ns = 0;
    int owner_id = 0;                         ///< id of the pseudo component __NAME
    std::vector<std::string> init_functions;  ///< run once
    std::vector<std::string> functions;       ///< in order of execution
    std::uint64_t overruns = 0;               ///< number of skipped releases
    std::int64_t max_latency_ns = 0;          ///< latency of the wake-up
    std::int64_t time_ns = 0;
    std::int64_t tmax_ns = 0;
};

class Threads {
  public:
    /// `scheduler`: null in an attached process.
    Threads(Instance &instance, detail::Segment &segment, runtime::Scheduler *scheduler);
    ~Threads();

    /// [host]
    Result<> create(std::string_view name, std::int64_t period_ns);
    /// [host]
    Result<> remove(std::string_view name);
    /// Stops and removes all threads, at the end of the instance. [host]
    void remove_all();
    /// Position 1 is the first, -1 the last.
    Result<> add_function(std::string_view function, std::string_view thread, int position = -1);
    /// The function runs once, in the next period of the running threads, before the other functions.
    Result<> add_init_function(std::string_view function, std::string_view thread, int position = -1);
    Result<> remove_function(std::string_view function, std::string_view thread);
    Result<> start();
    /// Stops the threads. After it returns no function runs, unless a thread made the call.
    Result<> stop();
    /// [any thread, realtime-safe]
    bool isRunning() const noexcept;
    /// Shortest period first; `glob` takes * ? [abc].
    std::vector<ThreadInfo> list(std::string_view glob = "*") const;
    /// Publishes overruns and latencies of the threads for other processes. [host]
    void publish_figures();

  private:
    // The caller of these functions holds the lock:
    void remove_record(detail::ThreadRecord &thread);
    void store_figures() const;

    Instance &instance_;
    detail::Segment &segment_;
    runtime::Scheduler *scheduler_;
    std::unique_ptr<detail::TickCounter> counter_;                ///< measures the run times of functions
    std::vector<std::unique_ptr<detail::ThreadRunner>> runners_;  ///< changed under the segment's lock
};

}  // namespace mw::hal

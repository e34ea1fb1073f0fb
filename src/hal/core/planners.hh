// SPDX-License-Identifier: GPL-2.0-or-later
// Planners of modules: periodic functions of the realtime process in separate threads, for work that may take
// longer than a servo period. In each function the current instance is its own instance. Not realtime-safe.
// [any non-realtime thread of the host]
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "base/result.hh"
#include "runtime/scheduler.hh"

namespace mw::hal {

namespace detail {
class Segment;
}
class Instance;

struct PlannerCode {
    void (*function)(void *, long long) = nullptr;  ///< called with the argument and the period in ns
    void *argument = nullptr;
};

class Planners {
  public:
    /// `scheduler`: null in an attached process.
    Planners(Instance &instance, detail::Segment &segment, runtime::Scheduler *scheduler);
    ~Planners();

    /// Returns the id.
    Result<int> create(const std::string &name, std::int64_t period_ns, const PlannerCode &code);
    /// False when no planner has this id.
    bool remove(int id);
    /// Removes all planners, at the end of the instance.
    void remove_all();

  private:
    struct Runner;
    static void run(void *runner, std::int64_t period_ns);

    Instance &instance_;
    detail::Segment &segment_;
    runtime::Scheduler *scheduler_;
    std::vector<std::unique_ptr<Runner>> runners_;  ///< changed under the segment's lock
    int last_id_ = 0;
};

}  // namespace mw::hal

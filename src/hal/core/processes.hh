// SPDX-License-Identifier: GPL-2.0-or-later
// The processes of an instance's components. Invariant: components of an ended process are removed, after
// their outputs have taken safe values. Not realtime-safe. [any non-realtime thread and process]
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/result.hh"
#include "runtime/process.hh"

namespace mw::hal {

namespace detail {
class Segment;
}
class ControllerWatches;

/// A component that was removed because its process died without leaving HAL.
struct DeathInfo {
    std::string name;
    int pid = 0;
    std::int64_t time_ns = 0;  ///< time of detection, as now_ns() of a realtime host
};

class Processes {
  public:
    Processes(detail::Segment &segment, ControllerWatches &watches) : segment_(segment), watches_(watches) {}

    /// The other processes with components, each listed once.
    std::vector<runtime::ProcessId> others() const;
    /// Removes components whose process has ended, after setting their outputs to safe values. Returns their
    /// names. A process with threads counts as ended as soon as its first thread has ended, before its pidfd
    /// reports it.
    std::vector<std::string> reap_dead();
    /// The process of this component will be ended on request, which does not count as a death.
    Result<> expect_end(int comp_id);
    /// The last components (at most 16) whose process died, oldest first; without components that were
    /// restarted.
    std::vector<DeathInfo> deaths() const;
    /// Keeps the components of this process until spare(0), also when reap_dead() runs, because the machine
    /// brakes through their outputs.
    void spare(std::int32_t pid);
    /// For a process that is stopped or hangs: sets its bit outputs to their safe values until the process
    /// writes them again.
    void set_safe_outputs(std::int32_t pid);

  private:
    detail::Segment &segment_;
    ControllerWatches &watches_;
};

}  // namespace mw::hal

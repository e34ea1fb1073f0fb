// SPDX-License-Identifier: GPL-2.0-or-later
// Where the leader is on the path and how fast, and where it will be when a plan made now begins.
#pragma once

#include <optional>

#include "trajectory/path/planned_path.hh"

namespace mw::trajectory {

struct LeaderState {
    Sequence piece = 0;
    double x = 0, v = 0;
    Coasting coasting;
};

/// Where an executor at rest goes on; nothing when there is no more of the path.
std::optional<LeaderState> start_state(const PlannedPath &path, const Snapshot &now) noexcept;

/// Until when the plan under way is known, and how far ahead a plan begins.
struct Outlook {
    Sequence phases_end = 0;    ///< of the plan that the executor follows
    std::uint64_t latency = 3;  ///< cycles
    double period_s = 1e-3;
};

/// The state that the executor will have when a plan made now can take over; nothing when it will have begun
/// to brake, or stands at the end of the path.
std::optional<LeaderState> predict(const PlannedPath &path, const Snapshot &now,
                                   const Outlook &outlook) noexcept;

}  // namespace mw::trajectory

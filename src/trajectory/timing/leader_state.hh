// SPDX-License-Identifier: GPL-2.0-or-later
// Position and speed of the reference on the path, now and when a plan made now begins.
#pragma once

#include <optional>

#include "trajectory/path/planned_path.hh"

namespace mw::trajectory {

struct LeaderState {
    Sequence piece = 0;
    double x = 0, v = 0;
};

/// Where a stopped executor continues; nothing at the end of the path.
std::optional<LeaderState> start_state(const PlannedPath &path, const Snapshot &now) noexcept;

/// Until when the plan under way is known, and how far ahead a plan begins.
struct Outlook {
    Sequence phases_end = 0;    ///< of the plan that the executor follows
    std::uint64_t latency = 3;  ///< cycles
    double period_s = 1e-3;
};

/// The state of the executor when a plan made now can take over; nothing when it will have begun to brake, or
/// is stopped at the end of the path.
std::optional<LeaderState> predict(const PlannedPath &path, const Snapshot &now,
                                   const Outlook &outlook) noexcept;

}  // namespace mw::trajectory

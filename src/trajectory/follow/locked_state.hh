// SPDX-License-Identifier: GPL-2.0-or-later
// What an executor remembers of a pass that is locked to the angle of a spindle. Realtime-safe.
#pragma once

#include <algorithm>
#include <cstdint>

#include "trajectory/path_store.hh"

namespace mw::trajectory {

/// The greatest of the values of the last cycles: of at least one mean, and of less than two.
class RecentMost {
  public:
    void take(double value, std::uint64_t mean_cycles) noexcept {
        if (++cycles_ > mean_cycles) {
            cycles_ = 1;
            before_ = now_;
            now_ = 0;
        }
        now_ = std::max(now_, value);
    }
    double most() const noexcept { return std::max(now_, before_); }

  private:
    double now_ = 0, before_ = 0;
    std::uint64_t cycles_ = 0;
};

/// The helix is x = per_turn (turned - origin - turns of the pieces passed).
struct LockedState {
    Pass pass;
    double origin = 0;        ///< turns of the spindle at which the helix passes the start
    double passed_turns = 0;  ///< of the pieces that are complete
    Sequence came_from = 0;   ///< piece at the start of the last cycle
    double gap = 0;           ///< of the last cycle: how far the tool is ahead of the helix
    int crossings = 0;        ///< of the helix by the tool, since the start
    int near_cycles = 0;      ///< since the tool was not near the helix
    double descent = 0;       ///< > 0: brakes with it to the end of the piece
    bool isOn = false;        ///< the tool is on the helix
    bool wasOn = false;       ///< it has been
    bool wasDescending = false;
    RecentMost gain;  ///< acceleration with which speed is gained [unit/s^2]

    /// Of a stop that nobody could foresee, on a piece that leaves `most`. It may come while speed is gained:
    /// the mean cannot turn all of that about.
    double dropping_acceleration(double most) const noexcept {
        const double wanted = pass.share * most;
        const double left = pass.swing - gain.most();
        return pass.swing > 0 ? std::min(wanted, std::max(left, pass.trim * most)) : wanted;
    }
};

}  // namespace mw::trajectory

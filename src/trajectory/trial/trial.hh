// SPDX-License-Identifier: GPL-2.0-or-later
// On machines whose joints are not axes a plan is checked before it is committed, sample by sample up to its
// stop, as the executor will drive it: speed and acceleration of the joints.
#pragma once

#include <array>

#include "trajectory/timing/speed_profile.hh"
#include "trajectory/trial/limit_trial.hh"
#include "trajectory/trial/verdict.hh"

namespace mw::trajectory {

/// The plan to be tried: phases [begin, end) from the state `from` on.
struct TrialPlan {
    LeaderState from;
    Sequence begin = 0, end = 0;
    Outlook outlook;  ///< what is still driven before it begins
};

/// Changes nothing but itself.
class Trial {
  public:
    Verdict check(const PathView &view, const Snapshot &now, const TrialPlan &plan) noexcept;
    /// Of the last failed check; pieces from `first_free` on can still be changed.
    Cause cause_of(const Verdict &verdict, Sequence first_free) const noexcept;

  private:
    bool push(const PathView &view, const Pose &pose, Sequence piece) noexcept;
    bool push_phase(const PathView &view, const Phase &phase, double t) noexcept;
    void drive_on(const PathView &view, const Snapshot &now, const TrialPlan &plan) noexcept;
    bool isPlanSound(const PathView &view, const TrialPlan &plan) noexcept;

    /// A sample depends on this many pieces: its own and those of the samples that differences reach.
    static constexpr std::uint64_t DEPENDS = 4;
    std::array<Sequence, DEPENDS> pieces_{};  ///< of the last samples, by tick; 0: none
    std::uint64_t tick_ = 0;                  ///< of the newest sample
    LimitTrial joints_;
};

}  // namespace mw::trajectory

// SPDX-License-Identifier: GPL-2.0-or-later
// A plan is checked before it is committed, sample by sample up to its stop, as the executor will drive it:
// acceleration step within the averaging time, deviation from the programmed path, speed and acceleration of
// the reference, joints.
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

/// Some hundred kilobytes, so never on a stack. Changes nothing but itself.
class Trial {
  public:
    Verdict check(const PathView &view, const Snapshot &now, const TrialPlan &plan) noexcept;
    /// Of the last failed check; pieces from `first_free` on can still be changed.
    Cause cause_of(const Verdict &verdict, const PathLimits &limits, Sequence first_free) const noexcept;

  private:
    struct Sample {
        LeaderSample leader;
        Pose bend;  ///< second difference of the reference positions
        Sequence piece = 0;
    };
    const Sample &sample(std::uint64_t tick) const noexcept { return samples_[tick % HISTORY_CAPACITY]; }
    Sample &sample(std::uint64_t tick) noexcept { return samples_[tick % HISTORY_CAPACITY]; }

    void start(const PathView &view, const Snapshot &now, const LeaderState &from) noexcept;
    void drive_on(const PathView &view, const Snapshot &now, const TrialPlan &plan) noexcept;
    bool isPlanSound(const PathView &view, const TrialPlan &plan) noexcept;
    void push_phase(const PathView &view, const Phase &phase, double t) noexcept;
    void push(const LeaderSample &sample, Sequence piece, std::uint64_t filter) noexcept;
    bool isNewestSound(const PathView &view) noexcept;
    bool isOnExactArc(const PathView &view) noexcept;
    bool isLeaderSound(const PathLimits &limits) const noexcept;
    bool isSwingSound(const PathLimits &limits) noexcept;
    bool isNearPath(const PathView &view) noexcept;
    static Sequence arc_at(const PathView &view, const LeaderSample &leader) noexcept;
    void take_arc(const PathView &view, const Snapshot &now) noexcept;
    Pose commanded(const PathView &view) noexcept;
    bool areJointsSound(const PathView &view) noexcept;
    bool areAxesSound(const PathView &view) noexcept;
    Pose mean(std::uint64_t filter) const noexcept {
        return origin_ + sum_ * (1.0 / static_cast<double>(filter));
    }
    Pose along_bend(std::uint64_t tick) const noexcept;
    double least_tolerance(std::uint64_t filter) const noexcept;
    double deviation(const PathView &view) const noexcept;

    std::array<Sample, HISTORY_CAPACITY> samples_{};
    std::uint64_t tick_ = 0;  ///< of the newest sample
    Pose sum_, origin_;       ///< of the samples in the average, from the origin
    double s_sum_ = 0, s_origin_ = 0;
    std::uint64_t tolerance_tick_ = 0;  ///< the newest sample whose tolerance differs from the one before
    std::uint64_t along_tick_ = 0;      ///< the last on an arc that is followed exactly
    Sequence arc_ = 0;                  ///< the move whose averaged position is commanded
    std::uint64_t arc_tick_ = 0;        ///< the last on it
    double excess_ = 1, along_share_ = 0;
    LimitTrial joints_;  ///< where they are not axes
    LimitTrial axes_;    ///< on an exact arc, where joints are axes
};

}  // namespace mw::trajectory

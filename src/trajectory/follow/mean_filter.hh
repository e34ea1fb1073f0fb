// SPDX-License-Identifier: GPL-2.0-or-later
// Mean of the last n poses. The mean of positions within limits of speed and acceleration keeps both limits,
// and its jerk is (a(t) - a(t - n T)) / (n T): see docs/developer/planner.md. Realtime-safe.
#pragma once

#include <cstdint>

#include "trajectory/path_store.hh"

namespace mw::trajectory {

class MeanFilter {
  public:
    /// From now on the mean is over `length` samples, of which all before this are `pose`.
    void reset(const Pose &pose, std::uint64_t length, std::uint64_t tick) noexcept {
        origin_ = pose;
        length_ = length;
        first_ = tick;
        sum_ = {};
        rest_ = {};
    }
    std::uint64_t length() const noexcept { return length_; }
    /// Samples before this tick are all `origin`.
    std::uint64_t first() const noexcept { return first_; }
    const Pose &origin() const noexcept { return origin_; }

    /// The mean with the sample of `tick`, which is in the history, as the newest.
    Pose push(const LeaderHistory &history, std::uint64_t tick) noexcept {
        const Pose &in = history[tick % HISTORY_CAPACITY].pose;
        const bool isOut = tick >= first_ + length_;
        const Pose &out = isOut ? history[(tick - length_) % HISTORY_CAPACITY].pose : origin_;
        Pose mean;
        for (int i = 0; i < geometry::AXIS_COUNT; ++i) {
            add(i, in[i] - origin_[i]);
            add(i, origin_[i] - out[i]);
            mean[i] = origin_[i] + (sum_[i] + rest_[i]) / static_cast<double>(length_);
        }
        return mean;
    }

  private:
    /// Adds without losing what a double cannot hold (two-sum).
    void add(int i, double x) noexcept {
        const double s = sum_[i] + x;
        const double back = s - sum_[i];
        rest_[i] += (sum_[i] - (s - back)) + (x - back);
        sum_[i] = s;
    }

    Pose origin_, sum_, rest_;
    std::uint64_t length_ = 1, first_ = 0;
};

}  // namespace mw::trajectory

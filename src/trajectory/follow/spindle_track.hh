// SPDX-License-Identifier: GPL-2.0-or-later
// Speed and acceleration of a spindle from its counted turns alone: what tells its speed apart may have no
// sign, or be late. Realtime-safe.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "trajectory/tuning.hh"

namespace mw::trajectory {

/// What is known of a spindle in a servo cycle.
struct SpindleReading {
    double turns = 0;
    double turns_per_s = 0;
    double turns_per_s2 = 0;
    /// Change of speed with which it turns back when it is told to, from turning on with the counts and from
    /// turning against them [turns/s^2]; 0: not known.
    std::array<double, 2> ramp{};
    double ramp_at(double speed) const noexcept { return speed >= 0 ? ramp[0] : ramp[1]; }
};

class SpindleTrack {
  public:
    /// Counted turns at the start of a cycle of `dt` seconds. With a mean of `mean_s` the acceleration is
    /// told over a longer time: what is aimed at lies farther ahead.
    void take(double turns, double dt, double mean_s) noexcept {
        constexpr std::size_t N = TapTuning::SPEED_SAMPLES;
        const double oldest = count_ >= N ? samples_[count_ % N] : turns;
        samples_[count_ % N] = turns;
        ++count_;
        const double speed = (turns - oldest) / (static_cast<double>(N) * dt);
        const double swing = (speed - speed_) / dt;
        const double smoothing_s =
            std::max(TapTuning::ACCELERATION_S, TapTuning::ACCELERATION_MEANS * mean_s);
        acceleration_ += (swing - acceleration_) * dt / (dt + smoothing_s);
        speed_ = speed;
        window_s_ = static_cast<double>(N) * dt;
    }
    double turns_per_s2() const noexcept { return acceleration_; }
    /// Brought from the middle of the samples to now.
    double turns_per_s() const noexcept { return speed_ + 0.5 * acceleration_ * window_s_; }

  private:
    std::array<double, TapTuning::SPEED_SAMPLES> samples_{};
    std::uint64_t count_ = 0;
    double speed_ = 0, acceleration_ = 0, window_s_ = 0;
};

/// What the executor knows of a spindle.
struct FollowedSpindle {
    double turns = 0;
    SpindleTrack track;
    std::array<double, 2> ramp{};
    SpindleReading reading() const noexcept {
        return {turns, track.turns_per_s(), track.turns_per_s2(), ramp};
    }
};

}  // namespace mw::trajectory

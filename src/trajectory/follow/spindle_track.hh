// SPDX-License-Identifier: GPL-2.0-or-later
// Speed and acceleration of a spindle, calculated from its counts only, because a separate speed signal may
// be unsigned or late. Realtime-safe.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "trajectory/path/spindle_braking.hh"

namespace mw::trajectory {

/// A filter for constant acceleration with fading memory. The effect of a change of the acceleration decays
/// with three equal poles. Source: Brookner, Tracking and Kalman Filtering Made Easy (1998), the critically
/// damped g-h-k filter.
class SpindleTrack {
  public:
    /// Takes the counted revolutions at the start of a cycle of `dt` [s].
    void take(double turns, double dt) noexcept {
        observe_step(turns);
        turns_ += dt * (speed_ + 0.5 * dt * acceleration_);
        speed_ += dt * acceleration_;
        const double missed = turns - turns_;
        if (std::abs(missed) > JUMP) {  // the counter was reset, or this is the first count
            turns_ = turns;
            readings_ = 1;
            return;
        }
        const double kept = 1.0 / (1.0 + std::min(rate_, HIGHEST_RATE / dt) * dt);
        const double fresh = 1.0 - kept;
        turns_ += (1.0 - kept * kept * kept) * missed;
        speed_ += 1.5 * fresh * fresh * (1.0 + kept) * missed / dt;
        acceleration_ += fresh * fresh * fresh * missed / (dt * dt);
    }
    double turns() const noexcept { return turns_; }
    double turns_per_s() const noexcept { return speed_; }
    double turns_per_s2() const noexcept { return acceleration_; }

    /// Resolution of the encoder [rev]: the median of the nonzero second differences of its counts. At a
    /// constant speed all of them are one step. If counts are read at uneven times, the result is larger.
    double step() const noexcept { return step_; }
    void set_rate(double rate) noexcept { rate_ = rate; }

    static constexpr double JUMP = 0.5;            ///< [rev]
    static constexpr double SMALLEST_STEP = 1e-6;  ///< [rev]
    /// Maximum relative change of the median by one second difference. For the n-th one since the start it is
    /// 1/n.
    static constexpr double STEP_GAIN = 0.02;
    static constexpr double HIGHEST_RATE = 0.6;  ///< maximum filter rate times the period

  private:
    void observe_step(double turns) noexcept {
        const double difference = std::abs(turns - 2.0 * last_ + before_);
        before_ = last_;
        last_ = turns;
        const bool is_difference = readings_ >= 2;
        readings_ += is_difference ? 0 : 1;
        if (is_difference && difference > SMALLEST_STEP && difference < JUMP) {
            const double most = std::max(STEP_GAIN, 1.0 / ++differences_) * step_;
            step_ += std::clamp(difference - step_, -most, most);
            differences_ = std::min(differences_, 1.0 / STEP_GAIN);
        }
    }

    double turns_ = 0, speed_ = 0, acceleration_ = 0;
    double last_ = 0, before_ = 0;
    int readings_ = 0;  ///< number of readings since the counter was reset, at most 2
    double step_ = JUMP;
    double differences_ = 0;  ///< number of second differences, at most 1/STEP_GAIN
    double rate_ = 150;       ///< [1/s]; a tap or a pass sets its own rate
};

/// Measured data of a spindle in a servo cycle.
struct SpindleReading {
    double turns = 0;
    double turns_per_s = 0;
    double turns_per_s2 = 0;
    SpindleBrakings brakings{};
    double step = SpindleTrack::JUMP;  ///< resolution of its encoder [rev]
    /// Revolutions to standstill after a reverse command now; 0: not known.
    double overrun() const noexcept { return braking_at(brakings, turns_per_s).overrun(turns_per_s); }
};

/// Spindle data of the executor.
struct FollowedSpindle {
    SpindleTrack track;
    SpindleBrakings brakings{};
    SpindleReading reading() const noexcept {
        return {track.turns(), track.turns_per_s(), track.turns_per_s2(), brakings, track.step()};
    }
};

}  // namespace mw::trajectory

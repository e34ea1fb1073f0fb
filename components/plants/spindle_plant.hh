// SPDX-License-Identifier: GPL-2.0-or-later
// A simulated spindle with its drive and its encoder: ramps, reacts late, slips under load; the encoder
// counts whole steps, has an index and may lose counts. Realtime-safe.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace mw::plants {

/// The properties of a spindle.
struct SpindleTraits {
    double ramp = 0;        ///< change of speed by the drive [turns/s^2]; 0: at once
    double lag_s = 0;       ///< first-order lag of the rotor behind the drive; 0: none
    double reaction_s = 0;  ///< time from a new command to the reaction of the drive
    double slip = 0;        ///< fraction of the speed that is lost at load 1
    int counts_per_turn = 4096;
    double first_turns = 0;  ///< angle at the start, relative to the zero of the encoder
};

/// The true angle of the rotor and, separately, the count of the encoder.
class SpindlePlant {
  public:
    explicit SpindlePlant(const SpindleTraits &traits) noexcept
        : traits_(traits), turns_(traits.first_turns) {
        count();
        has_index_ = false;
    }

    /// Sets another drive or load; counts and angle do not change.
    void set_drive(double ramp, double lag_s, double reaction_s, double slip) noexcept {
        traits_.ramp = number_or_zero(ramp);
        traits_.lag_s = number_or_zero(lag_s);
        traits_.reaction_s = number_or_zero(reaction_s);
        traits_.slip = std::clamp(number_or_zero(slip), 0.0, 1.0);
    }
    /// Turns for `dt` seconds with the command [turns/s] and a load from 0 to 1. A command that is not a
    /// number is ignored; no drive exceeds MOST_SPEED.
    void run(double command, double load, double dt) noexcept {
        const double asked_for = std::clamp(command, -MOST_SPEED, MOST_SPEED);
        if (asked_for != wanted_ && !std::isnan(asked_for)) {
            wanted_ = asked_for;
            since_s_ = 0;
        }
        const double loaded = std::clamp(number_or_zero(load), 0.0, 1.0);
        const double step = dt / STEPS;
        for (int n = 0; n < STEPS; ++n) {
            since_s_ += step;
            if (since_s_ >= traits_.reaction_s) {
                heard_ = wanted_;
            }
            const double most = traits_.ramp > 0 ? traits_.ramp * step : INFINITY;
            const double before = speed_;
            drive_ += std::clamp(heard_ - drive_, -most, most);
            const double asked = drive_ * (1.0 - traits_.slip * loaded);
            speed_ += traits_.lag_s > 0 ? (asked - speed_) * (1.0 - std::exp(-step / traits_.lag_s))
                                        : asked - speed_;
            const bool is_jump = traits_.ramp <= 0 && traits_.lag_s <= 0;
            turns_ += (is_jump ? speed_ : 0.5 * (before + speed_)) * step;
        }
        count();
    }
    /// From now on the encoder has lost this many counts, or counted too many.
    void lose_counts(std::int64_t counts) noexcept {
        lost_ += counts;
        count();
    }

    /// The true values [turns], [turns/s].
    double turns() const noexcept { return turns_; }
    double speed() const noexcept { return speed_; }
    /// Counts of the encoder since the start.
    std::int64_t counts() const noexcept { return counts_; }
    /// The encoder reading [turns].
    double shown_turns() const noexcept {
        return static_cast<double>(counts_ - zero_) / traits_.counts_per_turn;
    }
    /// The index was passed in the last `run`.
    bool hasIndex() const noexcept { return has_index_; }
    /// The encoder counts from the last index.
    void zero_at_index() noexcept { zero_ = index_; }

  private:
    static constexpr int STEPS = 20;
    static constexpr double MOST_SPEED = 1e6;   ///< [turns/s]
    static constexpr double MOST_EDGES = 9e18;  ///< the largest number of edges that is counted

    static double number_or_zero(double x) noexcept { return std::isnan(x) ? 0.0 : x; }

    static std::int64_t floor_to(std::int64_t counts, std::int64_t per_turn) noexcept {
        const std::int64_t rest = counts % per_turn;
        return counts - rest - (rest < 0 ? per_turn : 0);
    }
    void count() noexcept {
        const auto per_turn = static_cast<double>(traits_.counts_per_turn);
        const double passed = std::clamp(std::floor(turns_ * per_turn), -MOST_EDGES, MOST_EDGES);
        const auto edges = static_cast<std::int64_t>(passed);
        const std::int64_t mark = floor_to(edges, traits_.counts_per_turn);
        has_index_ = mark != mark_;
        index_ = std::max(mark, mark_) - lost_;
        mark_ = mark;
        counts_ = edges - lost_;
    }

    SpindleTraits traits_;
    double wanted_ = 0, heard_ = 0, since_s_ = 0;  ///< the command as sent, and as received by the drive
    double drive_ = 0, speed_ = 0, turns_;
    std::int64_t counts_ = 0, lost_ = 0, zero_ = 0;
    std::int64_t mark_ = 0;   ///< whole turns below the angle of the rotor, in edges
    std::int64_t index_ = 0;  ///< the encoder reading at the last index
    bool has_index_ = false;
};

}  // namespace mw::plants

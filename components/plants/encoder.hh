// SPDX-License-Identifier: GPL-2.0-or-later
// A position encoder with its counter: resolution, index marks at which the counter can be set to zero, and
// the faults of an encoder: counts that stop and counts that jump. Realtime-safe.
#pragma once

#include <cmath>

namespace mw::plants {

struct EncoderSettings {
    double counts_per_unit = 1e4;
    double index_spacing = 0;  ///< between index marks [unit]; 0: none
    double index_at = 0;       ///< position of one of them
};

class Encoder {
  public:
    /// The counter is zero at `position`.
    explicit Encoder(const EncoderSettings &settings = {}, double position = 0) noexcept
        : settings_(settings), zero_(position), seen_(position) {}

    /// Sets another resolution or other marks; the zero of the counter does not change.
    void set(const EncoderSettings &settings) noexcept { settings_ = settings; }
    /// Reads the shaft; a position that is not a number is ignored. With `index_armed` the counter is set to
    /// zero at the first mark that is passed; the return value reports this.
    bool run(double position, bool index_armed) noexcept {
        if (!std::isfinite(position)) {
            return false;
        }
        const double before = seen_;
        seen_ = position;
        if (lost_) {
            return false;
        }
        bool has_index = false;
        if (index_armed && settings_.index_spacing > 0) {
            const double a = (before - settings_.index_at) / settings_.index_spacing;
            const double b = (position - settings_.index_at) / settings_.index_spacing;
            has_index = std::isfinite(a) && std::isfinite(b) && std::floor(a) != std::floor(b);
            if (has_index) {
                const double mark = b > a ? std::floor(b) : std::floor(a);
                zero_ = settings_.index_at + mark * settings_.index_spacing;
            }
        }
        reading_ =
            std::floor((position - zero_) * settings_.counts_per_unit + 0.5) / settings_.counts_per_unit;
        return has_index;
    }

    /// The value of the counter [unit].
    double reading() const noexcept { return reading_; }
    /// The true position of the shaft where the counter is zero; only the plant knows it.
    double zero() const noexcept { return zero_; }

    /// The cable is unplugged: the counter stops. After it is plugged in again, counting continues from
    /// there.
    void lose(bool lost) noexcept {
        if (lost_ && !lost) {
            zero_ = seen_ - reading_;
        }
        lost_ = lost;
    }
    /// Adds counts that did not happen: the reading is larger by `by` from now on.
    void jump(double by) noexcept { zero_ -= std::isfinite(by) ? by : 0.0; }

  private:
    EncoderSettings settings_;
    double zero_;
    double seen_;
    double reading_ = 0;
    bool lost_ = false;
};

}  // namespace mw::plants

// SPDX-License-Identifier: GPL-2.0-or-later
// A position encoder with its counter: resolution, index marks at which the counter can be set to zero, and
// the faults of such a thing: counts that stand still, counts that jump. Realtime-safe.
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

    /// Another resolution or other marks from here on; the counter keeps its zero.
    void set(const EncoderSettings &settings) noexcept { settings_ = settings; }
    /// Looks at the shaft; a place that is no number is not seen. With `isIndexArmed` the counter is set to
    /// zero at the first mark that is passed; the return value says that this has happened.
    bool run(double position, bool isIndexArmed) noexcept {
        if (!std::isfinite(position)) {
            return false;
        }
        const double before = seen_;
        seen_ = position;
        if (isLost_) {
            return false;
        }
        bool hasIndex = false;
        if (isIndexArmed && settings_.index_spacing > 0) {
            const double a = (before - settings_.index_at) / settings_.index_spacing;
            const double b = (position - settings_.index_at) / settings_.index_spacing;
            hasIndex = std::isfinite(a) && std::isfinite(b) && std::floor(a) != std::floor(b);
            if (hasIndex) {
                const double mark = b > a ? std::floor(b) : std::floor(a);
                zero_ = settings_.index_at + mark * settings_.index_spacing;
            }
        }
        reading_ =
            std::floor((position - zero_) * settings_.counts_per_unit + 0.5) / settings_.counts_per_unit;
        return hasIndex;
    }

    /// What the counter says [unit].
    double reading() const noexcept { return reading_; }
    /// Position of the shaft where the counter is zero: what nobody but the plant knows.
    double zero() const noexcept { return zero_; }

    /// The cable is off: the counter stands still. Plugged in again it goes on counting from there.
    void lose(bool isLost) noexcept {
        if (isLost_ && !isLost) {
            zero_ = seen_ - reading_;
        }
        isLost_ = isLost;
    }
    /// Counts that were never there: the reading is `by` more from now on.
    void jump(double by) noexcept { zero_ -= std::isfinite(by) ? by : 0.0; }

  private:
    EncoderSettings settings_;
    double zero_;
    double seen_;
    double reading_ = 0;
    bool isLost_ = false;
};

}  // namespace mw::plants

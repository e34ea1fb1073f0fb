// SPDX-License-Identifier: GPL-2.0-or-later
// Waveforms of one frequency, without HAL. Realtime-safe.
#pragma once

#include <cmath>
#include <numbers>

namespace mw::siggen {

constexpr int MAX_CHANNELS = 16;

struct Waves {
    bool clock = false;
    double square = 0.0;
    double sine = 0.0;
    double cosine = 0.0;
    double triangle = 0.0;
    double sawtooth = 0.0;
};

class Generator {
  public:
    /// One sample, `dt` seconds after the previous one. `frequency` [Hz] is taken as positive and is limited
    /// to half the sample rate.
    Waves run(double frequency, double amplitude, double offset, bool is_reset, double dt) noexcept {
        if (is_reset) {
            phase_ = 0.5;
        } else {
            double step = std::fabs(frequency) * dt;
            step = step > 0.5 ? 0.5 : step;
            phase_ += step;
            if (phase_ > 1.0) {
                phase_ -= 1.0;
            }
        }
        // The wave starts at the positive peak of the triangle and the cosine; it rises in the second half.
        const bool is_second_half = phase_ > 0.5;
        const double angle = 2.0 * std::numbers::pi * phase_;
        Waves waves;
        waves.clock = is_second_half;
        waves.square = offset + (is_second_half ? amplitude : -amplitude);
        waves.sine = offset + amplitude * std::sin(angle);
        waves.cosine = offset + amplitude * std::cos(angle);
        waves.triangle = offset + amplitude * (is_second_half ? 4.0 * phase_ - 3.0 : 1.0 - 4.0 * phase_);
        waves.sawtooth = offset + amplitude * (2.0 * phase_ - 1.0);
        return waves;
    }

  private:
    double phase_ = 0.0;  ///< 0 to 1
};

}  // namespace mw::siggen

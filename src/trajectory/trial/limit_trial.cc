// SPDX-License-Identifier: GPL-2.0-or-later
#include "trajectory/trial/limit_trial.hh"

#include <cmath>

#include "trajectory/tuning.hh"

namespace mw::trajectory {

bool LimitTrial::isSound(const TriedLimits &limits, std::uint64_t tick) noexcept {
    samples_ = tick == tick_ + 1 ? samples_ + 1 : 0;
    tick_ = tick;
    const double t = limits.period_s;
    constexpr double SLACK = TrialTuning::SLACK;
    for (std::size_t i = 0; i < limits.count && samples_ >= 1; ++i) {
        const auto at = [&](std::uint64_t back) { return places_[(tick - back) % places_.size()][i]; };
        const double rounding = 0x1p-52 * std::abs(at(0));
        if (std::abs(at(0) - at(1)) > limits.velocity[i] * t * SLACK + 2.0 * rounding) {
            return false;
        }
        const double bend = samples_ >= 2 ? std::abs(at(0) - 2.0 * at(1) + at(2)) : 0.0;
        if (bend > limits.acceleration[i] * t * t * SLACK + 4.0 * rounding) {
            return false;
        }
    }
    return true;
}

}  // namespace mw::trajectory

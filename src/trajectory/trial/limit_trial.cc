// SPDX-License-Identifier: GPL-2.0-or-later
#include "trajectory/trial/limit_trial.hh"

#include <algorithm>
#include <cmath>

#include "trajectory/tuning.hh"

namespace mw::trajectory {

LimitTrial::Differences LimitTrial::differences(std::size_t i, std::uint64_t tick) const noexcept {
    const auto at = [&](std::uint64_t back) { return places_[(tick - back) % places_.size()][i]; };
    return {at(0) - at(1), at(0) - 2.0 * at(1) + at(2), at(0) - 3.0 * (at(1) - at(2)) - at(3)};
}

bool LimitTrial::keeps(const TriedLimits &limits, std::size_t i, const Differences &used,
                       double rounding) noexcept {
    const double t = limits.period_s;
    constexpr double SLACK = TrialTuning::SLACK;
    bool isSound = true;
    const auto keep = [&](double amount, double allowed, double excess) {
        isSound = isSound && !(amount > allowed);
        excess_ = amount > allowed ? std::max(excess_, excess) : excess_;
    };
    const double v = std::abs(used.velocity);
    const double v_most = limits.velocity[i] * t * SLACK + 2.0 * rounding;
    keep(v, v_most, v * v / (v_most * v_most));
    if (samples_ >= 2) {
        const double a = std::abs(used.acceleration);
        const double a_most = limits.acceleration[i] * t * t * SLACK + 4.0 * rounding;
        keep(a, a_most, a / a_most);
    }
    if (samples_ >= 3 && limits.isJerkLimited) {
        const double jerk = std::abs(used.jerk);
        const double jerk_most = limits.jerk[i] * t * t * t * SLACK + 8.0 * rounding;
        keep(jerk, jerk_most, jerk / jerk_most);
    }
    return isSound;
}

bool LimitTrial::isSound(const TriedLimits &limits, std::uint64_t tick) noexcept {
    excess_ = 0;
    samples_ = tick == tick_ + 1 ? samples_ + 1 : 0;
    tick_ = tick;
    if (samples_ < 1) {
        return true;
    }
    const double *now = places(tick);
    bool isSound = true;
    Differences norm;
    double most = limits.size;
    for (std::size_t i = 0; i < limits.count; ++i) {
        const Differences used = differences(i, tick);
        isSound = keeps(limits, i, used, 0x1p-52 * std::max(std::abs(now[i]), limits.size)) && isSound;
        if (limits.hasNorm && i < 3) {
            norm.velocity = std::hypot(norm.velocity, used.velocity);
            norm.acceleration = std::hypot(norm.acceleration, used.acceleration);
            norm.jerk = std::hypot(norm.jerk, used.jerk);
            most = std::max(most, std::abs(now[i]));
        }
    }
    return limits.hasNorm ? keeps(limits, limits.count, norm, 2.0 * 0x1p-52 * most) && isSound : isSound;
}

}  // namespace mw::trajectory

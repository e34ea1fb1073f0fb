// SPDX-License-Identifier: GPL-2.0-or-later
#include "trajectory/path/speed_choice.hh"

#include <algorithm>
#include <cmath>

namespace mw::trajectory {

namespace {

/// Relative error by rounding.
constexpr double ROUNDING = 1e-9;

bool isOver(double value, double most) noexcept {
    return !(value <= most * (1.0 + ROUNDING) + ROUNDING * ROUNDING);
}

}  // namespace

Overreach check_choice(const SpeedStretch &stretch, const AccelBound &bound,
                       std::span<const ChosenPhase> chosen) noexcept {
    using Kind = Overreach::Kind;
    if (chosen.empty()) {
        return {Kind::NO_ANSWER, 0};
    }
    double speed = stretch.speed;
    double total = 0;
    for (const ChosenPhase &phase : chosen) {
        const bool isNumber = std::isfinite(phase.length) && std::isfinite(phase.speed);
        if (!isNumber || phase.length < 0 || phase.speed < 0) {
            return {Kind::NO_ANSWER, 0};
        }
        if (isOver(phase.speed, stretch.cap)) {
            return {Kind::TOO_FAST, phase.speed / stretch.cap};
        }
        if (phase.length > 0 && !(speed + phase.speed > 0)) {
            return {Kind::NOT_THERE, total / stretch.length};
        }
        const double change = std::abs(phase.speed * phase.speed - speed * speed);
        const double top = std::max(speed, phase.speed);
        const double most = 2.0 * phase.length * bound.at(top * top);
        // A change by 1e-9 of the maximum speed is also rounding.
        if (isOver(change, most + 2.0 * ROUNDING * stretch.cap * stretch.cap)) {
            return {Kind::TOO_HARD, phase.length > 0 ? change / most : HUGE_VAL};
        }
        total += phase.length;
        speed = phase.speed;
    }
    if (std::abs(total - stretch.length) > ROUNDING * stretch.length) {
        return {Kind::NOT_THERE, total / stretch.length};
    }
    if (isOver(speed * speed, stretch.out * stretch.out + 2.0 * ROUNDING * stretch.cap * stretch.cap)) {
        return {Kind::TOO_LATE, stretch.out > 0 ? speed / stretch.out : HUGE_VAL};
    }
    return {};
}

}  // namespace mw::trajectory

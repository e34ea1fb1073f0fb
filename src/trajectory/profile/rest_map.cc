// SPDX-License-Identifier: GPL-2.0-or-later
#include "trajectory/profile/rest_map.hh"

#include <algorithm>
#include <cmath>

namespace mw::trajectory::profile {

namespace {

// s = l (2 x^3 - 2 x^4 + 0.6 x^5), x = p/l: at x = 1 its slope is 1 and its second and third derivative are
// 0.
constexpr double RAMP_LENGTH = 0.6;

MapPoint ramp(double p, double l) noexcept {
    const double x = p / l;
    return {l * x * x * x * (2 + x * (-2 + x * 0.6)), x * x * (6 + x * (-8 + x * 3)),
            x * (12 + x * (-24 + x * 12)) / l, (12 + x * (-48 + x * 36)) / (l * l)};
}

double inverse_ramp(double s, double l) noexcept {
    double x = std::cbrt(s / l / 2);
    for (int i = 0; i < 4; ++i) {
        const MapPoint m = ramp(x * l, l);
        x = m.first > 0 ? std::clamp(x + (s - m.s) / (m.first * l), 0.0, 1.0) : x;
    }
    return x * l;
}

}  // namespace

void RestMap::set_start(double s, double ramp) noexcept {
    start_s_ = s;
    start_ = ramp / RAMP_LENGTH;
}

void RestMap::set_end(double s, double ramp) noexcept {
    end_s_ = s;
    stop_ = ramp / RAMP_LENGTH;
    end_ = s - start_s_ + (1 - RAMP_LENGTH) * (start_ + stop_);
}

void RestMap::take_end_away() noexcept {
    end_s_ = end_ = 1e300;
    stop_ = 0;
}

MapPoint RestMap::at(double p) const noexcept {
    if (p < start_) {
        MapPoint m = ramp(p, start_);
        m.s += start_s_;
        return m;
    }
    const double left = end_ - p;
    if (left < stop_) {
        const MapPoint m = ramp(std::max(left, 0.0), stop_);
        return {end_s_ - m.s, m.first, -m.second, m.third};
    }
    return {start_s_ + p - (1 - RAMP_LENGTH) * start_, 1, 0, 0};
}

double RestMap::scale_of(double ramp) noexcept {
    constexpr double SHARE = 0.29;  // 1/sqrt(12): the third derivative of s = 2 p^3/l^2 is 12/l^2
    return SHARE * ramp / RAMP_LENGTH;
}

double RestMap::scale_at(double p) const noexcept {
    return p < start_         ? scale_of(RAMP_LENGTH * start_)
           : end_ - p < stop_ ? scale_of(RAMP_LENGTH * stop_)
                              : 1e300;
}

double RestMap::parameter_at(double s) const noexcept {
    if (s - start_s_ < RAMP_LENGTH * start_) {
        return inverse_ramp(std::max(s - start_s_, 0.0), start_);
    }
    if (end_s_ - s < RAMP_LENGTH * stop_) {
        return end_ - inverse_ramp(std::max(end_s_ - s, 0.0), stop_);
    }
    return s - start_s_ + (1 - RAMP_LENGTH) * start_;
}

}  // namespace mw::trajectory::profile

// SPDX-License-Identifier: GPL-2.0-or-later
#include "traj/free_planner.hh"

#include <algorithm>
#include <cmath>

namespace mw::traj {

double stop_position(double position, double velocity, double acceleration) noexcept {
    return acceleration > 0 ? position + velocity * std::abs(velocity) / (2.0 * acceleration) : position;
}

void FreePlanner::stop() noexcept {
    target = stop_position(position, velocity, max_acceleration);
}

namespace {

/// Moves on with constant acceleration for at most `span`; returns the time left of dt.
double go(double &p, double &v, double a, double span, double dt) noexcept {
    const double t = std::clamp(span, 0.0, dt);
    p += t * (v + 0.5 * a * t);
    v += a * t;
    return dt - t;
}

}  // namespace

void FreePlanner::step(double dt) noexcept {
    const double a = max_acceleration;
    if (!(a > 0) || isAtRest()) {
        velocity = a > 0 ? velocity : 0.0;
        return;
    }
    // Turned so that the target lies beyond the place where braking now would lead.
    const double sign = target >= stop_position(position, velocity, a) ? 1.0 : -1.0;
    const double d = (target - position) * sign;
    double p = 0;
    double v = velocity * sign;
    double left = dt;
    const double rise2 = a * d + 0.5 * v * v;
    const double peak = std::min(std::max(0.0, max_velocity), std::sqrt(std::max(0.0, rise2)));
    if (v > peak) {
        left = go(p, v, -a, (v - peak) / a, left);
    } else {
        left = go(p, v, a, (peak - v) / a, left);
    }
    if (left > 0) {
        v = peak;
        const double brake = peak * peak / (2.0 * a);
        const double cruise = peak > 0 ? std::max(0.0, (d - p - brake) / peak) : left;
        left = go(p, v, 0, cruise, left);
        if (left > 0) {
            left = go(p, v, -a, peak / a, left);
            if (left > 0) {
                position = target;
                velocity = 0;
                return;
            }
        }
    }
    position += p * sign;
    velocity = v * sign;
}

}  // namespace mw::traj

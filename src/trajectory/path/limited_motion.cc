// SPDX-License-Identifier: GPL-2.0-or-later
#include "trajectory/path/limited_motion.hh"

#include <algorithm>
#include <cmath>

namespace mw::trajectory {

// The acceleration rises to a peak in the direction of the change, remains there if the limit caps the peak,
// and falls to 0. Its integral is the change of speed: peak^2 = J dv + a^2 / 2.
SpeedChange speed_change(const MotionState &from, double to_v, double acceleration, double jerk) noexcept {
    const double change = to_v - from.v;
    // Change of speed while the acceleration goes to 0.
    const double by_itself = 0.5 * from.a * std::abs(from.a) / jerk;
    const double side = change >= by_itself ? 1.0 : -1.0;
    const double dv = side * change, a = side * from.a;
    const double free_peak = std::sqrt(std::max(0.0, jerk * dv + 0.5 * a * a));
    const double peak = std::max(std::min(free_peak, acceleration), 0.0);
    // Change of speed without the part at the peak. An acceleration above the limit falls to the limit.
    const double built = (peak >= a ? peak * peak - 0.5 * a * a : 0.5 * a * a) / jerk;
    const double held = peak > 0 && free_peak > acceleration ? std::max(0.0, (dv - built) / peak) : 0.0;
    SpeedChange out;
    const double rise = peak - a;
    out.parts[0] = {rise >= 0 ? side * jerk : -side * jerk, std::abs(rise) / jerk};
    out.parts[1] = {0, held};
    out.parts[2] = {-side * jerk, peak / jerk};
    MotionState end{0, from.v, from.a};
    for (const SpeedChange::Part &part : out.parts) {
        end = end.after(part.jerk, part.duration);
        out.duration += part.duration;
    }
    out.distance = end.x;
    return out;
}

double follow(MotionState &state, const SpeedChange &change, double left) noexcept {
    for (const SpeedChange::Part &part : change.parts) {
        const double t = part.duration < left ? part.duration : left;
        state = state.after(part.jerk, t);
        left -= t;
        if (!(left > 0)) {
            return 0;
        }
    }
    state.a = 0;
    return left;
}

bool SpeedChangeRun::advance(MotionState &state, double dt) noexcept {
    while (part_ < SpeedChange::PARTS) {
        const SpeedChange::Part &part = change_.parts[part_];
        const double left = part.duration - time_;
        if (dt < left) {
            state = state.after(part.jerk, dt);
            time_ += dt;
            return false;
        }
        state = state.after(part.jerk, std::max(0.0, left));
        dt -= std::max(0.0, left);
        time_ = 0;
        ++part_;
    }
    state.a = 0;
    return true;
}

}  // namespace mw::trajectory

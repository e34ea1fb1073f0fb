// SPDX-License-Identifier: GPL-2.0-or-later
// Spindles of machines, and the accuracy with which the tool can follow them.
#include <algorithm>
#include <cmath>

#include "base/geometry/pose.hh"
#include "campaign/design.hh"

namespace mw::campaign {

AxisDesign Design::z_with_joints() const {
    AxisDesign z = *std::ranges::find(axes, geometry::AXIS_Z, &AxisDesign::axis);
    for (const JointDesign &j : joints) {
        if (!isTrivial && !j.isAngular) {
            z.velocity = std::min(z.velocity, j.velocity);
            z.acceleration = std::min(z.acceleration, j.acceleration);
            z.jerk = z.jerk > 0 && j.jerk > 0 ? std::min(z.jerk, j.jerk) : std::max(z.jerk, j.jerk);
        }
    }
    return z;
}

double Design::off_helix(double lead, double ramp) const {
    constexpr double T = 1e-3, FOR_CURVES = 0.5;
    const double left = isTrivial ? 1 : FOR_CURVES;
    const AxisDesign z = z_with_joints();
    const double a = left * std::min(z.acceleration_of_path(), acceleration);
    const double most = jerk > 0 && z.jerk > 0 ? std::min(z.jerk, jerk) : std::max(z.jerk, jerk);
    const double j = isJerkLimited && most > 0 ? std::min(left * most, a / (4 * T)) : a / (4 * T);
    const double rate = std::min(0.6 / T, std::pow(4 * j * spindle.counts_per_turn / lead, 2.0 / 7));
    const double use = std::min(0.99, lead * ramp / a), built_s = use * a / j;
    return ramp * (4 / (rate * rate) + 10 * T * T + built_s * built_s * (1.0 / 6 + 0.125 * use / (1 - use)));
}

double Design::gentlest_ramp(double turns_s) const {
    constexpr double READING_S = 0.02;
    return turns_s / (turns_s / spindle.ramp + 2 * (spindle.lag_s + spindle.reaction_s) + READING_S);
}

void equip_spindle(plants::Random &random, Design &design) {
    plants::SpindleTraits &s = design.spindle;
    design.hasSpindlePlant = true;
    s.ramp = random.real(7000, 12000) / 60;
    s.lag_s = random.chance(0.5) ? 0 : random.real(0.001, 0.006);
    s.reaction_s = random.chance(0.5) ? 0 : random.real(0.001, 0.015);
    s.counts_per_turn = random.chance(0.7) ? 4096 : 1024;
    s.first_turns = random.real(0, 1);
}

}  // namespace mw::campaign

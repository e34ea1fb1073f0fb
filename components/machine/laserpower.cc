// SPDX-License-Identifier: GPL-2.0-or-later
// laserpower: scales a laser's power with the cutting speed, so that corners do not burn.
// While `enable` (bit) is true `out` is `power` times the ratio of `current-vel` to `requested-vel` (at most
// 1; 1 when requested-vel is 0), at least `min-fraction`, then limited to `min-power` (0) and `max-power`
// (100). When `distance-to-go` to the end of a move is below `reduce-distance` (0), the power is also
// reduced, down to min-fraction. While enable is false, or an input is not a number, out is 0. Other pins
// are float.
#include <cmath>

#include "components/limit/limit_core.hh"
#include "hal/sdk/component.hh"

namespace mw::components {
using namespace sdk;

struct Laserpower {
    In<bool> enable;
    In<double> power, current_vel, requested_vel, distance_to_go, reduce_distance;
    In<double> min_fraction, min_power, max_power;
    Out<double> out;

    void declare(Declare &d) noexcept {
        d.pin(enable, "enable");
        d.pin(power, "power");
        d.pin(current_vel, "current-vel");
        d.pin(requested_vel, "requested-vel");
        d.pin(distance_to_go, "distance-to-go");
        d.pin(reduce_distance, "reduce-distance");
        d.pin(min_fraction, "min-fraction");
        d.pin(min_power, "min-power");
        d.pin(max_power, "max-power", 100.0);
        d.pin(out, "out");
        d.function<&Laserpower::update>(this);
    }

    void update() noexcept {
        const double wanted_vel = std::fabs(requested_vel);
        double fraction = wanted_vel > 0.0 ? std::fabs(current_vel) / wanted_vel : 1.0;
        const double near = reduce_distance;
        if (near > 0.0 && distance_to_go < near) {
            fraction *= std::fabs(distance_to_go) / near;
        }
        const double bounded = limit::between(fraction, min_fraction, 1.0);
        const double wanted = limit::between(power * bounded, min_power, max_power);
        const bool possible = std::isfinite(wanted) && std::isfinite(fraction);
        out = enable && possible ? wanted : 0.0;
    }
};

}  // namespace mw::components

MW_COMPONENT(mw::components::Laserpower, "laserpower", mw::sdk::MANY);

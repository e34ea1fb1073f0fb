// SPDX-License-Identifier: GPL-2.0-or-later
// gearchange: the speed for a spindle with two gears. `sel` (bit) chooses the second.
//
// First gear: `speed-out` is `speed-in` limited to the parameters `min1` and `max1` (0 and 100000). Second
// gear: speed-in limited to `min2` and `max2`, divided by `scale2` (the ratio of the two gears; a value below
// 1 is set to 1). The limits apply to the magnitude of the speed; its sign is kept. `dir-out` (bit) is
// `dir-in`, inverted in second gear while the parameter `reverse` (bit) is true. Other pins float.
#include <cmath>

#include "components/limit/limit_core.hh"
#include "hal/sdk/component.hh"

namespace mw::components {
using namespace sdk;

struct Gearchange {
    In<bool> sel;
    In<double> speed_in;
    Out<double> speed_out;
    In<bool> dir_in;
    Out<bool> dir_out;
    ParamRw<double> min1, max1, min2, max2, scale2;
    ParamRw<bool> reverse;

    void declare(Declare &d) noexcept {
        d.pin(sel, "sel");
        d.pin(speed_in, "speed-in");
        d.pin(speed_out, "speed-out");
        d.pin(dir_in, "dir-in");
        d.pin(dir_out, "dir-out");
        d.param(min1, "min1");
        d.param(max1, "max1", 100000.0);
        d.param(min2, "min2");
        d.param(max2, "max2", 100000.0);
        d.param(scale2, "scale2", 1.0);
        d.param(reverse, "reverse");
        d.function<&Gearchange::update>(this);
    }

    void update() noexcept {
        const double wanted = speed_in;
        if (!(scale2 >= 1.0)) {
            scale2 = 1.0;
        }
        const bool is_second = sel;
        const double size = std::isfinite(wanted) ? std::fabs(wanted) : 0.0;
        const double speed =
            is_second ? limit::between(size, min2, max2) / scale2 : limit::between(size, min1, max1);
        speed_out = std::copysign(speed, wanted);
        dir_out = dir_in != (is_second && reverse);
    }
};

}  // namespace mw::components

MW_COMPONENT(mw::components::Gearchange, "gearchange", mw::sdk::MANY);

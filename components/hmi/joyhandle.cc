// SPDX-License-Identifier: GPL-2.0-or-later
// joyhandle: bends the curve of a joystick: `out` is scale * (a * in^power + b * in) + offset, with a and b
// such that it starts with offset at the deadband and ends with scale + offset at 1.
//
// Below `deadband` (0 to 0.99) out is 0, above 1 `out` remains constant. The curve is odd: a negative input
// has the negative output. With `inverse` (bit) the curve is reversed and starts steep. All other parameters
// and pins are float; power (2 at start) counts as 1 when less.
#include <cmath>

#include "components/limit/limit_core.hh"
#include "hal/sdk/component.hh"

namespace mw::components {
using namespace sdk;

struct Joyhandle {
    In<double> in;
    Out<double> out;
    ParamRw<double> power, deadband, scale, offset;
    ParamRw<bool> inverse;

    void declare(Declare &d) noexcept {
        d.pin(in, "in");
        d.pin(out, "out");
        d.param(power, "power", 2.0);
        d.param(deadband, "deadband");
        d.param(scale, "scale", 1.0);
        d.param(offset, "offset");
        d.param(inverse, "inverse");
        d.function<&Joyhandle::update>(this);
    }

    void update() noexcept {
        const double way = in;
        const double dead = limit::between(deadband, 0.0, 0.99);
        const double size = std::fabs(way);
        if (!(size > dead)) {
            out = 0.0;
            return;
        }
        const double x = size < 1.0 ? size : 1.0;
        const double bent = inverse ? 1.0 - curve(1.0 + dead - x, dead) : curve(x, dead);
        out = std::copysign(1.0, way) * (scale * bent + offset);
    }

  private:
    /// 0 at `dead`, 1 at 1.
    double curve(double x, double dead) const noexcept {
        const double exponent = power > 1.0 ? power.get() : 1.0;
        if (exponent == 1.0) {
            return (x - dead) / (1.0 - dead);
        }
        const double a = 1.0 / (1.0 - std::pow(dead, exponent - 1.0));
        return a * std::pow(x, exponent) + (1.0 - a) * x;
    }
};

}  // namespace mw::components

MW_COMPONENT(mw::components::Joyhandle, "joyhandle", mw::sdk::MANY);

// SPDX-License-Identifier: GPL-2.0-or-later
// led_dim: sets the brightness of a lamp as an eye perceives it. `in` (float, 0 to 1) is the requested
// lightness, `out` (float, 0 to 1) the luminance that an eye perceives as this lightness, as a duty cycle for
// pwmgen. The formula is the inverse of L* as a function of Y, from the International Commission on
// Illumination, 1931.
#include <cmath>

#include "components/limit/limit_core.hh"
#include "hal/sdk/component.hh"

namespace mw::components {
using namespace sdk;

struct LedDim {
    In<double> in;
    Out<double> out;

    void declare(Declare &d) noexcept {
        d.pin(in, "in");
        d.pin(out, "out");
        d.function<&LedDim::update>(this);
    }

    void update() noexcept {
        constexpr double PERCENT = 100.0;
        constexpr double STRAIGHT = 8.0, SLOPE = 903.3;  // below this lightness: a straight line
        constexpr double OFFSET = 16.0, SCALE = 116.0;
        const double lightness = PERCENT * (std::isfinite(in) ? limit::between(in, 0.0, 1.0) : 0.0);
        const double root = (lightness + OFFSET) / SCALE;
        out = lightness <= STRAIGHT ? lightness / SLOPE : root * root * root;
    }
};

}  // namespace mw::components

MW_COMPONENT(mw::components::LedDim, "led_dim", mw::sdk::MANY);

// SPDX-License-Identifier: GPL-2.0-or-later
// clarke3: the vector (x, y) and the common part h of three phases a, b, c 120 degrees apart. Pins float.
// Clarke transform, amplitude-invariant: x = (2 a - b - c) / 3, y = (b - c) / sqrt 3, h =
// sqrt 2 (a + b + c) / 3.
#include <numbers>

#include "hal/sdk/component.hh"

namespace mw::components {
using namespace sdk;

struct Clarke3 {
    In<double> a, b, c;
    Out<double> x, y, h;

    void declare(Declare &d) noexcept {
        d.pin(a, "a");
        d.pin(b, "b");
        d.pin(c, "c");
        d.pin(x, "x");
        d.pin(y, "y");
        d.pin(h, "h");
        d.function<&Clarke3::update>(this);
    }

    void update() noexcept {
        const double first = a;
        const double second = b;
        const double third = c;
        x = (2.0 * first - second - third) / 3.0;
        y = (second - third) * std::numbers::inv_sqrt3;
        h = (first + second + third) * std::numbers::sqrt2 / 3.0;
    }
};

}  // namespace mw::components

MW_COMPONENT(mw::components::Clarke3, "clarke3", mw::sdk::MANY);

// SPDX-License-Identifier: GPL-2.0-or-later
// clarke2: the vector (x, y) of three phases 120 degrees apart whose sum is zero, from two of them, a and b.
// Pins float. Clarke transform, amplitude-invariant: x = a, y = (a + 2 b) / sqrt 3.
#include <numbers>

#include "hal/sdk/component.hh"

namespace mw::components {
using namespace sdk;

struct Clarke2 {
    In<double> a, b;
    Out<double> x, y;

    void declare(Declare &d) noexcept {
        d.pin(a, "a");
        d.pin(b, "b");
        d.pin(x, "x");
        d.pin(y, "y");
        d.function<&Clarke2::update>(this);
    }

    void update() noexcept {
        const double first = a;
        x = first;
        y = (first + 2.0 * b) * std::numbers::inv_sqrt3;
    }
};

}  // namespace mw::components

MW_COMPONENT(mw::components::Clarke2, "clarke2", mw::sdk::MANY);

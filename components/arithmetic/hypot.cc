// SPDX-License-Identifier: GPL-2.0-or-later
// hypot: out = sqrt(in0^2 + in1^2 + in2^2). All pins float.
#include <cmath>

#include "hal/sdk/component.hh"

namespace mw::components {
using namespace sdk;

struct Hypot {
    In<double> in0, in1, in2;
    Out<double> out;

    void declare(Declare &d) noexcept {
        d.pin(in0, "in0");
        d.pin(in1, "in1");
        d.pin(in2, "in2");
        d.pin(out, "out");
        d.function<&Hypot::update>(this);
    }

    void update() noexcept {
        const double a = in0;
        const double b = in1;
        const double c = in2;
        out = std::sqrt(a * a + b * b + c * c);
    }
};

}  // namespace mw::components

MW_COMPONENT(mw::components::Hypot, "hypot", mw::sdk::MANY);

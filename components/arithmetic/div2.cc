// SPDX-License-Identifier: GPL-2.0-or-later
// div2: out = in0 / in1. A divisor nearer to zero than the parameter `deadband` counts as the deadband with
// its sign (positive for 0), so that `out` stays finite. A deadband below 1e-12 counts as 1e-12.
#include <cmath>

#include "components/arithmetic/divisor.hh"
#include "hal/sdk/component.hh"

namespace mw::components {
using namespace sdk;

struct Div2 {
    In<double> in0, in1;
    Out<double> out;
    ParamRw<double> deadband;

    void declare(Declare &d) noexcept {
        d.pin(in0, "in0");
        d.pin(in1, "in1");
        d.pin(out, "out");
        d.param(deadband, "deadband");
        d.function<&Div2::update>(this);
    }
    void update() noexcept { out = in0 / arithmetic::divisor(in1, deadband); }
};

}  // namespace mw::components

MW_COMPONENT(mw::components::Div2, "div2", mw::sdk::MANY);

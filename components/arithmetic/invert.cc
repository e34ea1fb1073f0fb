// SPDX-License-Identifier: GPL-2.0-or-later
// invert: out = 1 / in. An input nearer to zero than the parameter `deadband` counts as the deadband with its
// sign (positive for 0), so that `out` stays finite. A deadband below 1e-12 counts as 1e-12.
#include "components/arithmetic/divisor.hh"
#include "hal/sdk/component.hh"

namespace mw::components {
using namespace sdk;

struct Invert {
    In<double> in;
    Out<double> out;
    ParamRw<double> deadband;

    void declare(Declare &d) noexcept {
        d.pin(in, "in");
        d.pin(out, "out");
        d.param(deadband, "deadband");
        d.function<&Invert::update>(this);
    }
    void update() noexcept { out = 1.0 / arithmetic::divisor(in, deadband); }
};

}  // namespace mw::components

MW_COMPONENT(mw::components::Invert, "invert", mw::sdk::MANY);

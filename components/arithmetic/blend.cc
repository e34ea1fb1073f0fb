// SPDX-License-Identifier: GPL-2.0-or-later
// blend: `out` changes from `in2` to `in1` while `select` changes from 0 to 1. Outside this range `out`
// equals the nearer input, or is extrapolated while the parameter `open` (bit) is true. Pins float.
#include "components/limit/limit_core.hh"
#include "hal/sdk/component.hh"

namespace mw::components {
using namespace sdk;

struct Blend {
    In<double> in1, in2, select;
    Out<double> out;
    ParamRw<bool> open;

    void declare(Declare &d) noexcept {
        d.pin(in1, "in1");
        d.pin(in2, "in2");
        d.pin(select, "select");
        d.pin(out, "out");
        d.param(open, "open");
        d.function<&Blend::update>(this);
    }

    void update() noexcept {
        const double wanted = select;
        const double part = open ? wanted : limit::between(wanted, 0.0, 1.0);
        out = in1 * part + in2 * (1.0 - part);
    }
};

}  // namespace mw::components

MW_COMPONENT(mw::components::Blend, "blend", mw::sdk::MANY);

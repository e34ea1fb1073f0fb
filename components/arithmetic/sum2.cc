// SPDX-License-Identifier: GPL-2.0-or-later
// sum2: out = in0 * gain0 + in1 * gain1 + offset. Pins float; gain0, gain1 (1 at start) and offset are
// parameters.
#include "hal/sdk/component.hh"

namespace mw::components {
using namespace sdk;

struct Sum2 {
    In<double> in0, in1;
    Out<double> out;
    ParamRw<double> gain0, gain1, offset;

    void declare(Declare &d) noexcept {
        d.pin(in0, "in0");
        d.pin(in1, "in1");
        d.pin(out, "out");
        d.param(gain0, "gain0", 1.0);
        d.param(gain1, "gain1", 1.0);
        d.param(offset, "offset");
        d.function<&Sum2::update>(this);
    }
    void update() noexcept { out = in0 * gain0 + in1 * gain1 + offset; }
};

}  // namespace mw::components

MW_COMPONENT(mw::components::Sum2, "sum2", mw::sdk::MANY);

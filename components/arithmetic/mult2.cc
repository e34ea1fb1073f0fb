// SPDX-License-Identifier: GPL-2.0-or-later
// mult2: out = in0 * in1. All pins float.
#include "hal/sdk/component.hh"

namespace mw::components {
using namespace sdk;

struct Mult2 {
    In<double> in0, in1;
    Out<double> out;

    void declare(Declare &d) noexcept {
        d.pin(in0, "in0");
        d.pin(in1, "in1");
        d.pin(out, "out");
        d.function<&Mult2::update>(this);
    }
    void update() noexcept { out = in0 * in1; }
};

}  // namespace mw::components

MW_COMPONENT(mw::components::Mult2, "mult2", mw::sdk::MANY);

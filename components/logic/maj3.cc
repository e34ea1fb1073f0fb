// SPDX-License-Identifier: GPL-2.0-or-later
// maj3: `out` is the value of at least two of `in1`, `in2`, `in3`, inverted while the parameter `invert` is
// true.
#include "hal/sdk/component.hh"

namespace mw::components {
using namespace sdk;

struct Maj3 {
    In<bool> in1, in2, in3;
    Out<bool> out;
    ParamRw<bool> invert;

    void declare(Declare &d) noexcept {
        d.pin(in1, "in1");
        d.pin(in2, "in2");
        d.pin(in3, "in3");
        d.pin(out, "out");
        d.param(invert, "invert");
        d.function<&Maj3::update>(this);
    }

    void update() noexcept {
        const int trues = (in1 ? 1 : 0) + (in2 ? 1 : 0) + (in3 ? 1 : 0);
        out = (trues >= 2) != invert.get();
    }
};

}  // namespace mw::components

MW_COMPONENT(mw::components::Maj3, "maj3", mw::sdk::MANY);

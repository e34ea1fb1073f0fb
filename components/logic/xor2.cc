// SPDX-License-Identifier: GPL-2.0-or-later
// xor2: `out` is true while exactly one of `in0` and `in1` is true. All pins are of type bit.
#include "hal/sdk/component.hh"

namespace mw::components {
using namespace sdk;

struct Xor2 {
    In<bool> in0, in1;
    Out<bool> out;

    void declare(Declare &d) noexcept {
        d.pin(in0, "in0");
        d.pin(in1, "in1");
        d.pin(out, "out");
        d.function<&Xor2::update>(this);
    }
    void update() noexcept { out = in0.get() != in1.get(); }
};

}  // namespace mw::components

MW_COMPONENT(mw::components::Xor2, "xor2", mw::sdk::MANY);

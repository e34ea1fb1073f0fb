// SPDX-License-Identifier: GPL-2.0-or-later
// and2: `out` is true while `in0` and `in1` are. All pins bit.
#include "hal/sdk/component.hh"

namespace mw::components {
using namespace sdk;

struct And2 {
    In<bool> in0, in1;
    Out<bool> out;

    void declare(Declare &d) noexcept {
        d.pin(in0, "in0");
        d.pin(in1, "in1");
        d.pin(out, "out");
        d.function<&And2::update>(this);
    }
    void update() noexcept { out = in0 && in1; }
};

}  // namespace mw::components

MW_COMPONENT(mw::components::And2, "and2", mw::sdk::MANY);

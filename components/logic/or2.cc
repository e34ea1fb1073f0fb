// SPDX-License-Identifier: GPL-2.0-or-later
// or2: `out` is true while `in0` or `in1` is. All pins bit.
#include "hal/sdk/component.hh"

namespace mw::components {
using namespace sdk;

struct Or2 {
    In<bool> in0, in1;
    Out<bool> out;

    void declare(Declare &d) noexcept {
        d.pin(in0, "in0");
        d.pin(in1, "in1");
        d.pin(out, "out");
        d.function<&Or2::update>(this);
    }
    void update() noexcept { out = in0 || in1; }
};

}  // namespace mw::components

MW_COMPONENT(mw::components::Or2, "or2", mw::sdk::MANY);

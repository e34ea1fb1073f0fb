// SPDX-License-Identifier: GPL-2.0-or-later
// tristate_bit, tristate_float: copies `in` to the I/O pin `out` while `enable` (bit) is true and does not
// write it otherwise, so that several instances can drive one signal. Built once for each type (TRISTATE_TYPE
// and TRISTATE_MODULE).
#include "hal/sdk/component.hh"

namespace mw::components {
using namespace sdk;

struct Tristate {
    In<TRISTATE_TYPE> in;
    InOut<TRISTATE_TYPE> out;
    In<bool> enable;

    void declare(Declare &d) noexcept {
        d.pin(in, "in");
        d.pin(out, "out");
        d.pin(enable, "enable");
        d.function<&Tristate::update>(this);
    }

    void update() noexcept {
        if (enable) {
            out = in.get();
        }
    }
};

}  // namespace mw::components

MW_COMPONENT(mw::components::Tristate, TRISTATE_MODULE, mw::sdk::MANY);

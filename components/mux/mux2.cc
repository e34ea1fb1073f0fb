// SPDX-License-Identifier: GPL-2.0-or-later
// mux2: `out` (float) follows `in0` while `sel` (bit) is false, else `in1`.
#include "components/mux/selector.hh"
#include "hal/sdk/component.hh"

namespace mw::components {
using namespace sdk;

struct Mux2 {
    In<bool> sel;
    Out<double> out;
    In<double> in[2];

    void declare(Declare &d) noexcept {
        d.pin(sel, "sel");
        d.pin(out, "out");
        d.pin(in[0], "in0");
        d.pin(in[1], "in1");
        d.function<&Mux2::update>(this);
    }
    void update() noexcept { out = in[mux::index_of_bits(sel.get())].get(); }
};

}  // namespace mw::components

MW_COMPONENT(mw::components::Mux2, "mux2", mw::sdk::MANY);

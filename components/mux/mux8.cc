// SPDX-License-Identifier: GPL-2.0-or-later
// mux8: `out` (float) follows the input of `in0` to `in7` that `sel2` `sel1` `sel0` (bit) select.
#include "components/mux/selector.hh"
#include "hal/sdk/component.hh"

namespace mw::components {
using namespace sdk;

struct Mux8 {
    static constexpr int INPUTS = 8;
    In<bool> sel0, sel1, sel2;
    Out<double> out;
    In<double> in[INPUTS];

    void declare(Declare &d) noexcept {
        d.pin(sel0, "sel0");
        d.pin(sel1, "sel1");
        d.pin(sel2, "sel2");
        d.pin(out, "out");
        for (int i = 0; i < INPUTS; ++i) {
            d.pin_at(in[i], "in%d", i);
        }
        d.function<&Mux8::update>(this);
    }
    void update() noexcept { out = in[mux::index_of_bits(sel0.get(), sel1.get(), sel2.get())].get(); }
};

}  // namespace mw::components

MW_COMPONENT(mw::components::Mux8, "mux8", mw::sdk::MANY);

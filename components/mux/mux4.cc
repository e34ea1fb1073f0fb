// SPDX-License-Identifier: GPL-2.0-or-later
// mux4: `out` (float) follows the input of `in0` to `in3` whose number is `sel0` + 2 `sel1` (bits).
#include "components/mux/selector.hh"
#include "hal/sdk/component.hh"

namespace mw::components {
using namespace sdk;

struct Mux4 {
    In<bool> sel0, sel1;
    Out<double> out;
    In<double> in[4];

    void declare(Declare &d) noexcept {
        d.pin(sel0, "sel0");
        d.pin(sel1, "sel1");
        d.pin(out, "out");
        for (int i = 0; i < 4; ++i) {
            d.pin_at(in[i], "in%d", i);
        }
        d.function<&Mux4::update>(this);
    }
    void update() noexcept { out = in[mux::index_of_bits(sel0.get(), sel1.get())].get(); }
};

}  // namespace mw::components

MW_COMPONENT(mw::components::Mux4, "mux4", mw::sdk::MANY);

// SPDX-License-Identifier: GPL-2.0-or-later
// flipflop: a rising edge of `clk` copies `data` to `out`; `set` makes it true, `reset` false (and has
// priority). `out-not` is the opposite of `out`. All pins bit; the outputs are I/O so that others may preset
// them.
#include "hal/sdk/component.hh"

namespace mw::components {
using namespace sdk;

struct Flipflop {
    In<bool> data, clk, set, reset;
    InOut<bool> out, out_not;
    bool last_clk = false;

    void declare(Declare &d) noexcept {
        d.pin(data, "data");
        d.pin(clk, "clk");
        d.pin(set, "set");
        d.pin(reset, "reset");
        d.pin(out, "out");
        d.pin(out_not, "out-not");
        d.function<&Flipflop::update>(this);
    }

    void update() noexcept {
        const bool clock = clk;
        bool value = out;
        if (reset) {
            value = false;
        } else if (set) {
            value = true;
        } else if (clock && !last_clk) {
            value = data;
        }
        last_clk = clock;
        out = value;
        out_not = !value;
    }
};

}  // namespace mw::components

MW_COMPONENT(mw::components::Flipflop, "flipflop", mw::sdk::MANY);

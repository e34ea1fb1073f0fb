// SPDX-License-Identifier: GPL-2.0-or-later
// lut5: any function of five bits. The inputs `in-0` (lowest) to `in-4` make a number from 0 to 31; `out` is
// the bit of that number in the parameter `function` (u32).
#include "hal/sdk/component.hh"

namespace mw::components {
using namespace sdk;

struct Lut5 {
    static constexpr int INPUTS = 5;
    In<bool> in[INPUTS];
    Out<bool> out;
    ParamRw<std::uint32_t> table;

    void declare(Declare &d) noexcept {
        for (int i = 0; i < INPUTS; ++i) {
            d.pin_at(in[i], "in-%d", i);
        }
        d.pin(out, "out");
        d.param(table, "function");
        d.function<&Lut5::update>(this);
    }

    void update() noexcept {
        unsigned row = 0;
        for (int i = 0; i < INPUTS; ++i) {
            row |= in[i] ? 1U << i : 0U;
        }
        out = (table >> row & 1U) != 0;
    }
};

}  // namespace mw::components

MW_COMPONENT(mw::components::Lut5, "lut5", mw::sdk::MANY);

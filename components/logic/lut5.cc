// SPDX-License-Identifier: GPL-2.0-or-later
// lut5: any function of five bits. The inputs `in-0` (lowest) to `in-4` make a number from 0 to 31; `out` is
// the bit of that number in the parameter `function` (u32).
#include "components/common/kit.hh"

namespace mw::components {

struct Lut5 {
    static constexpr int INPUTS = 5;
    In<bool> in[INPUTS];
    Out<bool> out;
    ParamRw<std::uint32_t> table;

    void declare(Declare &d) noexcept {
        for (int i = 0; i < INPUTS; ++i) {
            pin_at(d, in[i], "in-%d", i);
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

MW_INSTANCES(Lut5, "lut5");

// SPDX-License-Identifier: GPL-2.0-or-later
// bitwise: bit by bit logic of `in0` and `in1` (u32): out-and, out-or, out-xor, out-nand, out-nor, out-xnor.
#include "hal/sdk/component.hh"

namespace mw::components {
using namespace sdk;

struct Bitwise {
    In<std::uint32_t> in0, in1;
    Out<std::uint32_t> out_and, out_or, out_xor, out_nand, out_nor, out_xnor;

    void declare(Declare &d) noexcept {
        d.pin(in0, "in0");
        d.pin(in1, "in1");
        d.pin(out_and, "out-and");
        d.pin(out_or, "out-or");
        d.pin(out_xor, "out-xor");
        d.pin(out_nand, "out-nand");
        d.pin(out_nor, "out-nor");
        d.pin(out_xnor, "out-xnor");
        d.function<&Bitwise::update>(this);
    }

    void update() noexcept {
        const std::uint32_t a = in0;
        const std::uint32_t b = in1;
        out_and = a & b;
        out_or = a | b;
        out_xor = a ^ b;
        out_nand = ~(a & b);
        out_nor = ~(a | b);
        out_xnor = ~(a ^ b);
    }
};

}  // namespace mw::components

MW_COMPONENT(mw::components::Bitwise, "bitwise", mw::sdk::MANY);

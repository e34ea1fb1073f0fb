// SPDX-License-Identifier: GPL-2.0-or-later
// bitslice: the bits of `in` (u32) as outputs `out-NN` (bit), out-00 the lowest; `personality=` gives the
// number of outputs of each instance, up to 32.
#include "hal/sdk/component.hh"

MW_PERSONALITY("bits of each instance");

namespace mw::components {
using namespace sdk;

struct Bitslice {
    static constexpr int MAX_BITS = 32;
    int bits = 0;
    In<std::uint32_t> in;
    Out<bool> out[MAX_BITS];

    void declare(Declare &d) noexcept {
        bits = d.personality_number(personality[d.index()], 0, MAX_BITS, "bits");
        d.pin(in, "in");
        for (int i = 0; i < bits; ++i) {
            d.pin_at(out[i], "out-%02d", i);
        }
        d.function<&Bitslice::update>(this);
    }

    void update() noexcept {
        const std::uint32_t value = in;
        for (int i = 0; i < bits; ++i) {
            out[i] = (value >> i & 1U) != 0;
        }
    }
};

}  // namespace mw::components

MW_COMPONENT(mw::components::Bitslice, "bitslice", mw::sdk::MANY);

// SPDX-License-Identifier: GPL-2.0-or-later
// bitmerge: `out` (u32) is the number with the bits `in-NN` (bit), in-00 the lowest; `personality=` gives the
// number of inputs of each instance, up to 32 (the default).
#include "hal/sdk/component.hh"

MW_PERSONALITY("bits of each instance");

namespace mw::components {
using namespace sdk;

struct Bitmerge {
    static constexpr int MAX_BITS = 32;
    int bits = 0;
    In<bool> in[MAX_BITS];
    Out<std::uint32_t> out;

    void declare(Declare &d) noexcept {
        bits = d.personality_number(personality[d.index()], MAX_BITS, MAX_BITS, "bits");
        for (int i = 0; i < bits; ++i) {
            d.pin_at(in[i], "in-%02d", i);
        }
        d.pin(out, "out");
        d.function<&Bitmerge::update>(this);
    }

    void update() noexcept {
        std::uint32_t value = 0;
        for (int i = 0; i < bits; ++i) {
            value |= in[i] ? 1U << i : 0U;
        }
        out = value;
    }
};

}  // namespace mw::components

MW_COMPONENT(mw::components::Bitmerge, "bitmerge", mw::sdk::MANY);

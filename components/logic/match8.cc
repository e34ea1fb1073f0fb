// SPDX-License-Identifier: GPL-2.0-or-later
// match8: `out` is true while each of `a0` to `a7` equals its `b0` to `b7` and `in` (true at start; the out
// of another instance, to compare more bits) is true.
#include "hal/sdk/component.hh"

namespace mw::components {
using namespace sdk;

struct Match8 {
    static constexpr int BITS = 8;
    In<bool> in;
    In<bool> a[BITS], b[BITS];
    Out<bool> out;

    void declare(Declare &d) noexcept {
        d.pin(in, "in", true);
        for (int i = 0; i < BITS; ++i) {
            d.pin_at(a[i], "a%d", i);
            d.pin_at(b[i], "b%d", i);
        }
        d.pin(out, "out");
        d.function<&Match8::update>(this);
    }

    void update() noexcept {
        bool is_match = in;
        for (int i = 0; i < BITS; ++i) {
            is_match = is_match && a[i].get() == b[i].get();
        }
        out = is_match;
    }
};

}  // namespace mw::components

MW_COMPONENT(mw::components::Match8, "match8", mw::sdk::MANY);

// SPDX-License-Identifier: GPL-2.0-or-later
// match8: `out` is true while each of `a0` to `a7` equals its `b0` to `b7` and `in` (true at start; the out
// of another instance, to compare more bits) is true.
#include "components/common/kit.hh"

namespace mw::components {

struct Match8 {
    static constexpr int BITS = 8;
    In<bool> in;
    In<bool> a[BITS], b[BITS];
    Out<bool> out;

    void declare(Declare &d) noexcept {
        d.pin(in, "in", true);
        for (int i = 0; i < BITS; ++i) {
            pin_at(d, a[i], "a%d", i);
            pin_at(d, b[i], "b%d", i);
        }
        d.pin(out, "out");
        d.function<&Match8::update>(this);
    }

    void update() noexcept {
        bool isMatch = in;
        for (int i = 0; i < BITS; ++i) {
            isMatch = isMatch && a[i].get() == b[i].get();
        }
        out = isMatch;
    }
};

}  // namespace mw::components

MW_INSTANCES(Match8, "match8");

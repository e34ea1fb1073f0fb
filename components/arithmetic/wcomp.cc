// SPDX-License-Identifier: GPL-2.0-or-later
// wcomp: `out` (bit) is true while `in` is between `min` and `max`, `under` while it is at most min, `over`
// while it is at least max. Other pins float. With max below min, `under` and `over` may be true at once.
#include "hal/sdk/component.hh"

namespace mw::components {
using namespace sdk;

struct Wcomp {
    In<double> in, min, max;
    Out<bool> out, under, over;

    void declare(Declare &d) noexcept {
        d.pin(in, "in");
        d.pin(min, "min");
        d.pin(max, "max");
        d.pin(out, "out");
        d.pin(under, "under");
        d.pin(over, "over");
        d.function<&Wcomp::update>(this);
    }

    void update() noexcept {
        const double value = in;
        const double low = min;
        const double high = max;
        out = low < value && value < high;
        under = value <= low;
        over = value >= high;
    }
};

}  // namespace mw::components

MW_COMPONENT(mw::components::Wcomp, "wcomp", mw::sdk::MANY);

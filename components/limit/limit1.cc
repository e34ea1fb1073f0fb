// SPDX-License-Identifier: GPL-2.0-or-later
// limit1: `out` is `in` limited to `min` and `max`. All pins float; the limits start at -1e20 and 1e20. While
// the input is not a number, the output does not change.
#include "components/limit/limit_core.hh"
#include "hal/sdk/component.hh"

namespace mw::components {
using namespace sdk;

struct Limit1 {
    In<double> in;
    Out<double> out;
    In<double> min, max;

    void declare(Declare &d) noexcept {
        d.pin(in, "in");
        d.pin(out, "out");
        d.pin(min, "min", -1e20);
        d.pin(max, "max", 1e20);
        d.function<&Limit1::update>(this);
    }
    void update() noexcept {
        set_finite(out, limit::between(in, min, max));
        // A limit that has moved inwards also applies to the previous value.
        out = limit::between(out, min, max);
    }
};

}  // namespace mw::components

MW_COMPONENT(mw::components::Limit1, "limit1", mw::sdk::MANY);

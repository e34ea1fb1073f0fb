// SPDX-License-Identifier: GPL-2.0-or-later
// minmax: `min` and `max` are the least and the largest value of `in` since `reset` (bit) was true; while it
// is true both follow in. Other pins float; both are 0 at start.
#include "hal/sdk/component.hh"

namespace mw::components {
using namespace sdk;

struct Minmax {
    In<double> in;
    In<bool> reset;
    Out<double> max, min;

    void declare(Declare &d) noexcept {
        d.pin(in, "in");
        d.pin(reset, "reset");
        d.pin(max, "max");
        d.pin(min, "min");
        d.function<&Minmax::update>(this);
    }

    void update() noexcept {
        const double value = in;
        const bool is_reset = reset;
        if (is_reset || value > max) {
            max = value;
        }
        if (is_reset || value < min) {
            min = value;
        }
    }
};

}  // namespace mw::components

MW_COMPONENT(mw::components::Minmax, "minmax", mw::sdk::MANY);

// SPDX-License-Identifier: GPL-2.0-or-later
// comp: compares two floats, with hysteresis.
//
// `out` (bit) becomes true when in1 - in0 exceeds hyst/2 and false when it falls below -hyst/2; with `hyst` 0
// it is simply in1 > in0. `equal` (bit) is true while |in1 - in0| is at most hyst/2. `hyst` is a parameter
// [units of in].
#include <cmath>

#include "hal/sdk/component.hh"

namespace mw::components {
using namespace sdk;

struct Comp {
    In<double> in0, in1;
    Out<bool> out, equal;
    ParamRw<double> hyst;

    void declare(Declare &d) noexcept {
        d.pin(in0, "in0");
        d.pin(in1, "in1");
        d.pin(out, "out");
        d.pin(equal, "equal");
        d.param(hyst, "hyst");
        d.function<&Comp::update>(this);
    }

    void update() noexcept {
        const double difference = in1 - in0;
        const double band = 0.5 * hyst;
        if (difference > band) {
            out = true;
        } else if (difference < -band || band == 0.0) {
            out = false;
        }
        equal = std::fabs(difference) <= band;
    }
};

}  // namespace mw::components

MW_COMPONENT(mw::components::Comp, "comp", mw::sdk::MANY);

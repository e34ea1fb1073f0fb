// SPDX-License-Identifier: GPL-2.0-or-later
// near: `out` (bit) is true while `in1` and `in2` (float) differ by at most `difference`, or by at most the
// factor `scale` in either direction. Both are parameters (0 and 1 at start).
#include <cmath>

#include "hal/sdk/component.hh"

namespace mw::components {
using namespace sdk;

struct Near {
    In<double> in1, in2;
    Out<bool> out;
    ParamRw<double> scale, difference;

    void declare(Declare &d) noexcept {
        d.pin(in1, "in1");
        d.pin(in2, "in2");
        d.pin(out, "out");
        d.param(scale, "scale", 1.0);
        d.param(difference, "difference");
        d.function<&Near::update>(this);
    }

    void update() noexcept {
        const double a = in1;
        const double b = in2;
        const double factor = scale >= 1.0 ? scale.get() : 1.0 / scale;
        const bool close = std::fabs(a - b) <= difference;
        const double low = a >= 0.0 ? a / factor : a * factor;
        const double high = a >= 0.0 ? a * factor : a / factor;
        out = close || (low <= b && b <= high);
    }
};

}  // namespace mw::components

MW_COMPONENT(mw::components::Near, "near", mw::sdk::MANY);

// SPDX-License-Identifier: GPL-2.0-or-later
// integ: `out` grows by gain * in per second, limited to `min` and `max`; `reset` (bit) sets it to 0. Other
// pins float; gain is 1 and the limits -1e20 and 1e20 at start. An input that is not a number adds nothing.
#include <cmath>

#include "components/limit/limit_core.hh"
#include "hal/sdk/component.hh"

namespace mw::components {
using namespace sdk;

struct Integ {
    In<double> in, gain;
    Out<double> out;
    In<bool> reset;
    In<double> max, min;

    void declare(Declare &d) noexcept {
        d.pin(in, "in");
        d.pin(gain, "gain", 1.0);
        d.pin(out, "out");
        d.pin(reset, "reset");
        d.pin(max, "max", 1e20);
        d.pin(min, "min", -1e20);
        d.function<&Integ::update>(this);
    }

    void update(long period_ns) noexcept {
        const double step = in * gain * seconds(period_ns);
        const double sum = reset ? 0.0 : out.get() + (std::isfinite(step) ? step : 0.0);
        out = limit::between(sum, min, max);
    }
};

}  // namespace mw::components

MW_COMPONENT(mw::components::Integ, "integ", mw::sdk::MANY);

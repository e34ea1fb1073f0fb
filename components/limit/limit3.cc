// SPDX-License-Identifier: GPL-2.0-or-later
// limit3: `out` follows `in`, limited to `min` and `max`, with at most `maxv` change per second and `maxa`
// change of that per second. While `enable` (bit, true at start) is false out returns to 0 within the limits;
// `load` (bit) sets out to in at once. `smooth-steps` (u32, 2 at start): number of periods over which the end
// of a move
// is spread. Other pins float, the limits start at -1e20 and 1e20.
// While the input is not a number, the output does not change.
#include "components/limit/limit_core.hh"
#include "hal/sdk/component.hh"

namespace mw::components {
using namespace sdk;

struct Limit3 {
    In<double> in;
    In<bool> enable;
    Out<double> out;
    In<bool> load;
    In<double> min, max, maxv, maxa;
    In<std::uint32_t> smooth_steps;
    limit::Limit3 state;

    void declare(Declare &d) noexcept {
        d.pin(in, "in");
        d.pin(enable, "enable", true);
        d.pin(out, "out");
        d.pin(load, "load");
        d.pin(min, "min", -1e20);
        d.pin(max, "max", 1e20);
        d.pin(maxv, "maxv", 1e20);
        d.pin(maxa, "maxa", 1e20);
        d.pin(smooth_steps, "smooth-steps", 2U);
        d.function<&Limit3::update>(this);
    }

    void update(long period_ns) noexcept {
        const limit::Limit3::Bounds bounds{min, max, maxv, maxa};
        const double input = enable ? in.get() : 0.0;
        const double target = std::isfinite(input) ? input : state.out;
        if (load) {
            state.load(limit::between(target, bounds.min, bounds.max));
        } else {
            state.run(target, bounds, static_cast<double>(period_ns) * 1e-9, smooth_steps);
        }
        out = state.out;
    }
};

}  // namespace mw::components

MW_COMPONENT(mw::components::Limit3, "limit3", mw::sdk::MANY);

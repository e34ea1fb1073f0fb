// SPDX-License-Identifier: GPL-2.0-or-later
// limit2: `out` follows `in`, limited to `min` and `max`, and changes by at most `maxv` per second. `load`
// (bit) sets out to in at once (within min and max). Other pins float; the limits start at -1e20 and 1e20.
// While the input is not a number, the output does not change.
#include "components/limit/limit_core.hh"
#include "hal/sdk/component.hh"

namespace mw::components {
using namespace sdk;

struct Limit2 {
    In<double> in;
    Out<double> out;
    In<bool> load;
    In<double> min, max, maxv;
    double last = 0.0;

    void declare(Declare &d) noexcept {
        d.pin(in, "in");
        d.pin(out, "out");
        d.pin(load, "load");
        d.pin(min, "min", -1e20);
        d.pin(max, "max", 1e20);
        d.pin(maxv, "maxv", 1e20);
        d.function<&Limit2::update>(this);
    }

    void update(long period_ns) noexcept {
        const double input = in;
        const double wanted = limit::between(std::isfinite(input) ? input : last, min, max);
        const double step = maxv * static_cast<double>(period_ns) * 1e-9;
        last = load ? wanted : limit::between(wanted, last - step, last + step);
        out = last;
    }
};

}  // namespace mw::components

MW_COMPONENT(mw::components::Limit2, "limit2", mw::sdk::MANY);

// SPDX-License-Identifier: GPL-2.0-or-later
// ddt: `out` is the change of `in` (float) since the call before, per second.
#include "hal/sdk/component.hh"

namespace mw::components {
using namespace sdk;

struct Ddt {
    In<double> in;
    Out<double> out;
    double last = 0.0;

    void declare(Declare &d) noexcept {
        d.pin(in, "in");
        d.pin(out, "out");
        d.function<&Ddt::update>(this);
    }

    void update(long period_ns) noexcept {
        const double value = in;
        out = (value - last) / (static_cast<double>(period_ns) * 1e-9);
        last = value;
    }
};

}  // namespace mw::components

MW_COMPONENT(mw::components::Ddt, "ddt", mw::sdk::MANY);

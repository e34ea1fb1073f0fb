// SPDX-License-Identifier: GPL-2.0-or-later
// supply: values for tests, up to 8 channels (`num_chan=`, 1 by default). Function supply.N.update: `q` (bit)
// is `d`, `q-not` (old name _q) its inverse; `variable` (float) is `value`, `variable-not` (_variable) its
// negative. d and value are I/O pins.
#include "hal/sdk/component.hh"

namespace mw::components {
using namespace sdk;

struct Supply {
    Out<bool> q, q_not;
    Out<double> variable, variable_not;
    InOut<bool> d_in;
    InOut<double> value;

    void declare(Declare &d) noexcept {
        d.pin(q, "q");
        d.legacy_pin(q_not, "q-not", "_q", true);
        d.pin(variable, "variable");
        d.legacy_pin(variable_not, "variable-not", "_variable");
        d.pin(d_in, "d");
        d.pin(value, "value");
        d.function<&Supply::update>(this, "update");
    }

    void update() noexcept {
        const bool bit = d_in;
        const double number = value;
        q = bit;
        q_not = !bit;
        variable = number;
        variable_not = -number;
    }
};

}  // namespace mw::components

MW_MODULE("supply", num_chan, 1, 8, mw::sdk::load_instances<mw::components::Supply>);

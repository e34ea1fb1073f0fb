// SPDX-License-Identifier: GPL-2.0-or-later
// supply: values for tests, up to 8 channels (`num_chan=`, 1 by default). Function supply.N.update: `q` (bit)
// is `d`, `q-not` (old name _q) its inverse; `variable` (float) is `value`, `variable-not` (_variable) its
// negative. d and value are I/O pins.
#include "components/common/kit.hh"

namespace mw::components {

struct Supply {
    Out<bool> q, q_not;
    Out<double> variable, variable_not;
    InOut<bool> d_in;
    InOut<double> value;

    void declare(Declare &d) noexcept {
        d.pin(q, "q");
        legacy_pin(d, q_not, "q-not", "_q", true);
        d.pin(variable, "variable");
        legacy_pin(d, variable_not, "variable-not", "_variable");
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

MW_MODULE("supply", num_chan, 1, 8, load_instances<mw::components::Supply>);

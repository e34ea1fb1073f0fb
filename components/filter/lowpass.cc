// SPDX-License-Identifier: GPL-2.0-or-later
// lowpass: out += (in - out) * gain in every period; `load` (bit) copies in to out instead. Pins float,
// `gain` is a parameter: 1 - exp(-2 pi f T) for a corner frequency f [Hz] and a period T [s].
#include "hal/sdk/component.hh"

namespace mw::components {
using namespace sdk;

struct Lowpass {
    In<double> in;
    Out<double> out;
    In<bool> load;
    ParamRw<double> gain;

    void declare(Declare &d) noexcept {
        d.pin(in, "in");
        d.pin(out, "out");
        d.pin(load, "load");
        d.param(gain, "gain");
        d.function<&Lowpass::update>(this);
    }

    void update() noexcept {
        const double input = in;
        const double output = out;
        out = load ? input : output + (input - output) * gain;
    }
};

}  // namespace mw::components

MW_COMPONENT(mw::components::Lowpass, "lowpass", mw::sdk::MANY);

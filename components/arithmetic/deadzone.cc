// SPDX-License-Identifier: GPL-2.0-or-later
// deadzone: `out` is `center` while `in` is within half of `threshold` of it. Outside, `out` is `in` reduced
// by that half, so that it does not jump. Pins and parameters (center 0, threshold 1 at start) are float.
#include "hal/sdk/component.hh"

namespace mw::components {
using namespace sdk;

struct Deadzone {
    In<double> in;
    Out<double> out;
    ParamRw<double> center, threshold;

    void declare(Declare &d) noexcept {
        d.pin(in, "in");
        d.pin(out, "out");
        d.param(center, "center");
        d.param(threshold, "threshold", 1.0);
        d.function<&Deadzone::update>(this);
    }

    void update() noexcept {
        const double value = in;
        const double half = threshold / 2.0;
        const double low = center - half;
        const double high = center + half;
        out = value < low ? value + half : (value > high ? value - half : center.get());
    }
};

}  // namespace mw::components

MW_COMPONENT(mw::components::Deadzone, "deadzone", mw::sdk::MANY);

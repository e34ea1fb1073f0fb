// SPDX-License-Identifier: GPL-2.0-or-later
// feedcomp: `out` is `in` times `vel` / `feed` while `enable` (bit) is true, otherwise `in`, for example for
// the power of a laser. Pins float; feed is a parameter. A feed of 0 gives 0.
#include <cmath>

#include "hal/sdk/component.hh"

namespace mw::components {
using namespace sdk;

struct Feedcomp {
    Out<double> out;
    In<double> in;
    In<bool> enable;
    In<double> vel;
    ParamRw<double> feed;

    void declare(Declare &d) noexcept {
        d.pin(out, "out");
        d.pin(in, "in");
        d.pin(enable, "enable");
        d.pin(vel, "vel");
        d.param(feed, "feed");
        d.function<&Feedcomp::update>(this);
    }

    void update() noexcept {
        const double value = in;
        const double scaled = value * (vel / feed);
        out = !enable ? value : (std::isfinite(scaled) ? scaled : 0.0);
    }
};

}  // namespace mw::components

MW_COMPONENT(mw::components::Feedcomp, "feedcomp", mw::sdk::MANY);

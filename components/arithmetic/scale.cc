// SPDX-License-Identifier: GPL-2.0-or-later
// scale: out = in * gain + offset. All pins float.
#include "hal/sdk/component.hh"

namespace mw::components {
using namespace sdk;

struct Scale {
    In<double> in, gain, offset;
    Out<double> out;

    void declare(Declare &d) noexcept {
        d.pin(in, "in");
        d.pin(gain, "gain");
        d.pin(offset, "offset");
        d.pin(out, "out");
        d.function<&Scale::update>(this);
    }
    void update() noexcept { out = in * gain + offset; }
};

}  // namespace mw::components

MW_COMPONENT(mw::components::Scale, "scale", mw::sdk::MANY);

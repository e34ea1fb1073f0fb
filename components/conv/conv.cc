// SPDX-License-Identifier: GPL-2.0-or-later
// conv_FROM_TO: `out` is `in` as another type. Built once for each pair (CONV_FROM, CONV_TO and CONV_MODULE
// are set by the build).
// If TO cannot hold all values of FROM, there is an output `out-of-range` (bit) and a parameter `clamp`
// (bit):
// true uses the nearest value for such an input, false lets it wrap around. A bit is true for any integer but
// 0
// and any float except those close to 0.
#include "components/conv/conv_core.hh"
#include "hal/sdk/component.hh"

namespace mw::components {
using namespace sdk;

struct Conv {
    In<CONV_FROM> in;
    Out<CONV_TO> out;
    Out<bool> out_of_range;
    ParamRw<bool> clamp;

    void declare(Declare &d) noexcept {
        d.pin(in, "in");
        d.pin(out, "out");
        if constexpr (conv::canOverflow<CONV_FROM, CONV_TO>()) {
            d.pin(out_of_range, "out-of-range");
            d.param(clamp, "clamp");
        }
        d.function<&Conv::update>(this);
    }

    void update() noexcept {
        const conv::Converted<CONV_TO> result = conv::convert<CONV_TO>(in.get(), clamp);
        out = result.value;
        if constexpr (conv::canOverflow<CONV_FROM, CONV_TO>()) {
            out_of_range = result.out_of_range;
        }
    }
};

}  // namespace mw::components

MW_COMPONENT(mw::components::Conv, CONV_MODULE, mw::sdk::MANY);

// SPDX-License-Identifier: GPL-2.0-or-later
// sample_hold: `out` follows `in` (s32) while `hold` (bit) is false.
#include "hal/sdk/component.hh"

namespace mw::components {
using namespace sdk;

struct SampleHold {
    In<std::int32_t> in;
    In<bool> hold;
    Out<std::int32_t> out;

    void declare(Declare &d) noexcept {
        d.pin(in, "in");
        d.pin(hold, "hold");
        d.pin(out, "out");
        d.function<&SampleHold::update>(this);
    }

    void update() noexcept {
        if (!hold) {
            out = in.get();
        }
    }
};

}  // namespace mw::components

MW_COMPONENT(mw::components::SampleHold, "sample_hold", mw::sdk::MANY);

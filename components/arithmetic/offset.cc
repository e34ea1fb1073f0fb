// SPDX-License-Identifier: GPL-2.0-or-later
// offset: adds an offset to a command and subtracts it from the feedback. Pins float.
//
// Function update-output: out = in + offset. Function update-feedback: fb-out = fb-in - offset.
#include "hal/sdk/component.hh"

namespace mw::components {
using namespace sdk;

struct Offset {
    In<double> offset, in, fb_in;
    Out<double> out, fb_out;

    void declare(Declare &d) noexcept {
        d.pin(offset, "offset");
        d.pin(in, "in");
        d.pin(out, "out");
        d.pin(fb_in, "fb-in");
        d.pin(fb_out, "fb-out");
        d.function<&Offset::update_output>(this, "update-output");
        d.function<&Offset::update_feedback>(this, "update-feedback");
    }
    void update_output() noexcept { out = in + offset; }
    void update_feedback() noexcept { fb_out = fb_in - offset; }
};

}  // namespace mw::components

MW_COMPONENT(mw::components::Offset, "offset", mw::sdk::MANY);

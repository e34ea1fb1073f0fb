// SPDX-License-Identifier: GPL-2.0-or-later
// toggle2nist, momentary2nist: one button for a device with separate inputs for on and off. A press of `in`
// (bit) makes `on` true until `is-on` shows that the device is on; a press while is-on is true makes `off`
// true until is-on is false. All pins bit. Presses in between are ignored. Built twice (BUTTON_MODULE).
#include "hal/sdk/component.hh"

namespace mw::components {
using namespace sdk;

struct Button2nist {
    In<bool> in, is_on;
    Out<bool> on, off;
    bool last_in = false;

    void declare(Declare &d) noexcept {
        d.pin(in, "in");
        d.pin(is_on, "is-on");
        d.pin(on, "on");
        d.pin(off, "off");
        d.function<&Button2nist::update>(this);
    }

    void update() noexcept {
        const bool input = in;
        const bool is_lit = is_on;
        const bool pressed = input && !last_in;
        last_in = input;
        const bool busy = on || off;
        on = !is_lit && (on || (pressed && !busy));
        off = is_lit && (off || (pressed && !busy));
    }
};

}  // namespace mw::components

MW_COMPONENT(mw::components::Button2nist, BUTTON_MODULE, mw::sdk::MANY);

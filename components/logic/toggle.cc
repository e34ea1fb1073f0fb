// SPDX-License-Identifier: GPL-2.0-or-later
// toggle: each press of the button `in` (bit) changes `out` (bit, I/O), which others may set too. The
// parameter `debounce` (u32, 2 at start) is the minimum time that the button must be pressed or released
// [periods].
#include "components/logic/debouncer.hh"
#include "hal/sdk/component.hh"

namespace mw::components {
using namespace sdk;

struct Toggle {
    In<bool> in;
    InOut<bool> out;
    ParamRw<std::uint32_t> debounce;
    logic::Debouncer debouncer;
    bool was_pressed = false;

    void declare(Declare &d) noexcept {
        d.pin(in, "in");
        d.pin(out, "out");
        d.param(debounce, "debounce", 2U);
        d.function<&Toggle::update>(this);
    }

    void update() noexcept {
        const bool pressed = debouncer.run(in, static_cast<long>(debounce.get()));
        if (pressed && !was_pressed) {
            out = !out;
        }
        was_pressed = pressed;
    }
};

}  // namespace mw::components

MW_COMPONENT(mw::components::Toggle, "toggle", mw::sdk::MANY);

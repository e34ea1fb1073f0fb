// SPDX-License-Identifier: GPL-2.0-or-later
// radiobutton: exactly one of the outputs `out-NN` (bit) is true: the one whose `in-NN` (bit) became true
// last.
//
// `personality=` gives the number of buttons, 2 to 32 (default 8). `selected` (u32, I/O) is the number of the
// one that is true; it may be set from outside, and starts at 0. When several become true in one period the
// lowest counts. `enable` (bit, true at start): while false the inputs are ignored.
#include "hal/sdk/component.hh"

MW_PERSONALITY("buttons of each instance");

namespace mw::components {
using namespace sdk;

struct Radiobutton {
    static constexpr int MAX_BUTTONS = 32;
    static constexpr int DEFAULT_BUTTONS = 8;
    int buttons = 0;
    In<bool> enable;
    In<bool> in[MAX_BUTTONS];
    Out<bool> out[MAX_BUTTONS];
    InOut<std::uint32_t> selected;
    std::uint32_t last_inputs = 0;

    void declare(Declare &d) noexcept {
        buttons = d.personality_number(personality[d.index()], DEFAULT_BUTTONS, MAX_BUTTONS, "buttons");
        d.pin(enable, "enable", true);
        for (int i = 0; i < buttons; ++i) {
            d.pin_at(in[i], "in-%02d", i);
            d.pin_at(out[i], "out-%02d", i);
        }
        d.pin(selected, "selected");
        d.function<&Radiobutton::update>(this);
    }

    void update() noexcept {
        std::uint32_t inputs = 0;
        for (int i = 0; i < buttons; ++i) {
            inputs |= in[i] ? 1U << i : 0U;
        }
        const std::uint32_t pressed = inputs & ~last_inputs;
        last_inputs = inputs;
        std::uint32_t chosen = selected;
        if (enable && pressed != 0) {
            chosen = static_cast<std::uint32_t>(__builtin_ctz(pressed));
        }
        const std::uint32_t last = static_cast<std::uint32_t>(buttons - 1);
        chosen = chosen < last ? chosen : last;
        selected = chosen;
        for (int i = 0; i < buttons; ++i) {
            out[i] = static_cast<std::uint32_t>(i) == chosen;
        }
    }
};

}  // namespace mw::components

MW_COMPONENT(mw::components::Radiobutton, "radiobutton", mw::sdk::MANY);

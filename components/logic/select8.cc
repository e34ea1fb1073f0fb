// SPDX-License-Identifier: GPL-2.0-or-later
// select8: sets the output of `out0` to `out7` (bit) whose number is in `sel` (s32) to true while `enable`
// (bit, true at start) is true; all others are false.
#include "hal/sdk/component.hh"

namespace mw::components {
using namespace sdk;

struct Select8 {
    static constexpr int OUTPUTS = 8;
    In<bool> enable;
    In<std::int32_t> sel;
    Out<bool> out[OUTPUTS];

    void declare(Declare &d) noexcept {
        d.pin(enable, "enable", true);
        d.pin(sel, "sel");
        for (int i = 0; i < OUTPUTS; ++i) {
            d.pin_at(out[i], "out%d", i);
        }
        d.function<&Select8::update>(this);
    }

    void update() noexcept {
        const bool enabled = enable;
        const std::int32_t selected = sel;
        for (int i = 0; i < OUTPUTS; ++i) {
            out[i] = enabled && i == selected;
        }
    }
};

}  // namespace mw::components

MW_COMPONENT(mw::components::Select8, "select8", mw::sdk::MANY);

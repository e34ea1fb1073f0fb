// SPDX-License-Identifier: GPL-2.0-or-later
// demux: sets the selected one of the outputs `out-NN` (bit) to true; `personality=` gives the number of
// outputs, up to 32 (the default).
//
// The number is `sel-u32` (u32) plus the binary number of sel-bit-00 to sel-bit-04 (bit); one that is too
// large selects the last output. With the parameter `bargraph` (bit) as many outputs as the number are true.
#include "hal/sdk/component.hh"

MW_PERSONALITY("outputs of each instance");

namespace mw::components {
using namespace sdk;

struct Demux {
    static constexpr int MAX_OUTPUTS = 32;
    static constexpr int SELECT_BITS = 5;
    int outputs = 0;
    In<bool> sel_bit[SELECT_BITS];
    In<std::uint32_t> sel_u32;
    Out<bool> out[MAX_OUTPUTS];
    ParamRw<bool> bargraph;

    void declare(Declare &d) noexcept {
        outputs = d.personality_number(personality[d.index()], MAX_OUTPUTS, MAX_OUTPUTS, "outputs");
        for (int i = 0; i < SELECT_BITS; ++i) {
            d.pin_at(sel_bit[i], "sel-bit-%02d", i);
        }
        d.pin(sel_u32, "sel-u32");
        for (int i = 0; i < outputs; ++i) {
            d.pin_at(out[i], "out-%02d", i);
        }
        d.param(bargraph, "bargraph");
        d.function<&Demux::update>(this);
    }

    void update() noexcept {
        std::uint64_t selected = sel_u32;
        for (int i = 0; i < SELECT_BITS; ++i) {
            selected += sel_bit[i] ? 1U << i : 0U;
        }
        const std::uint64_t last = static_cast<std::uint64_t>(outputs - 1);
        const std::uint64_t chosen = selected < last ? selected : last;
        const bool is_bar = bargraph;
        for (int i = 0; i < outputs; ++i) {
            const std::uint64_t number = static_cast<std::uint64_t>(i);
            out[i] = is_bar ? number < selected : number == chosen;
        }
    }
};

}  // namespace mw::components

MW_COMPONENT(mw::components::Demux, "demux", mw::sdk::MANY);

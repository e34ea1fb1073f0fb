// SPDX-License-Identifier: GPL-2.0-or-later
// sim_matrix_kb: the key codes of a simulated keyboard with 8 by 8 buttons. When `button.cCC.rRR` (bit)
// changes, `out` (u32) is for one period its number, 8 * row + column, plus 0xC0 when pressed and 0x80 when
// released; one change per period, lower columns first. Otherwise it is 0x40 while a button is pressed, else
// 0.
#include "hal/sdk/component.hh"

namespace mw::components {
using namespace sdk;

struct SimMatrixKb {
    static constexpr int SIZE = 8;
    Out<std::uint32_t> out;
    In<bool> button[SIZE * SIZE];
    std::uint64_t last = 0;

    void declare(Declare &d) noexcept {
        d.pin(out, "out");
        for (int i = 0; i < SIZE * SIZE; ++i) {
            char name[HAL_NAME_LEN + 1];
            rtapi_snprintf(name, sizeof name, "button.c%02d.r%02d", i / SIZE, i % SIZE);
            d.pin(button[i], name);
        }
        d.function<&SimMatrixKb::update>(this);
    }

    void update() noexcept {
        for (std::uint32_t i = 0; i < SIZE * SIZE; ++i) {
            const std::uint32_t number = SIZE * (i % SIZE) + i / SIZE;
            const bool pressed = button[i];
            const std::uint64_t mask = std::uint64_t{1} << i;
            const bool was_pressed = (last & mask) != 0;
            if (pressed != was_pressed) {
                last ^= mask;
                out = number + (pressed ? 0xc0U : 0x80U);
                return;
            }
        }
        out = last != 0 ? 0x40U : 0U;
    }
};

}  // namespace mw::components

MW_COMPONENT(mw::components::SimMatrixKb, "sim_matrix_kb", mw::sdk::MANY);

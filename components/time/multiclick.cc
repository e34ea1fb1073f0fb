// SPDX-License-Identifier: GPL-2.0-or-later
// multiclick: single to quadruple clicks of the button `in` (bit).
// A click is a press of at most max-hold-ns; clicks at most max-space-ns apart count together. At the end of
// click N the output N-click (single-click, double-click, triple-click, quadruple-click) becomes true for
// output-hold-ns; N-click-only does so when no further click can follow. Parameters (u32) [ns]:
// max-hold-ns and max-space-ns (250000000 at start), output-hold-ns (100000000); `invert-input` (bit): the
// button is false when pressed. `state` (s32): 0 idle, 2N-1 in press N, 2N after it, 9 waiting for a
// release.
#include "hal/sdk/component.hh"

namespace mw::components {
using namespace sdk;

constexpr int CLICKS = 4;
constexpr std::int32_t WAITING = 9;
constexpr const char *CLICK_NAMES[CLICKS] = {"single-click", "double-click", "triple-click",
                                             "quadruple-click"};

/// An output that stays true for some time.
struct Pulse {
    Out<bool> out;
    std::int64_t age_ns = 0;

    void start() noexcept {
        out = true;
        age_ns = 0;
    }
    void run(std::int64_t width_ns, std::int64_t period_ns) noexcept {
        age_ns += period_ns;
        if (out && age_ns >= width_ns) {
            out = false;
        }
    }
};

struct Multiclick {
    In<bool> in;
    Pulse click[CLICKS], only[CLICKS];
    Out<std::int32_t> state;
    ParamRw<bool> invert_input;
    ParamRw<std::uint32_t> max_hold_ns, max_space_ns, output_hold_ns;
    std::int64_t waited_ns = 0;

    void declare(Declare &d) noexcept;
    void update(long period_ns) noexcept;

  private:
    void go(std::int32_t next) noexcept {
        state = next;
        waited_ns = 0;
    }
};

void Multiclick::declare(Declare &d) noexcept {
    d.pin(in, "in");
    for (int i = 0; i < CLICKS; ++i) {
        char name[HAL_NAME_LEN + 1];
        rtapi_snprintf(name, sizeof name, "%s-only", CLICK_NAMES[i]);
        d.pin(click[i].out, CLICK_NAMES[i]);
        d.pin(only[i].out, name);
    }
    d.pin(state, "state");
    d.param(invert_input, "invert-input");
    d.param(max_hold_ns, "max-hold-ns", 250000000U);
    d.param(max_space_ns, "max-space-ns", 250000000U);
    d.param(output_hold_ns, "output-hold-ns", 100000000U);
    d.function<&Multiclick::update>(this);
}

void Multiclick::update(long period_ns) noexcept {
    for (int i = 0; i < CLICKS; ++i) {
        click[i].run(output_hold_ns, period_ns);
        only[i].run(output_hold_ns, period_ns);
    }
    waited_ns += period_ns;
    const bool pressed = in != invert_input;
    const std::int32_t now = state;
    if (now == WAITING) {
        if (!pressed) {
            go(0);
        }
        return;
    }
    const bool in_press = now % 2 != 0;
    if (in_press && !pressed) {
        click[now / 2].start();
        go(now + 1);
    } else if (in_press && waited_ns > max_hold_ns) {
        go(WAITING);
    } else if (!in_press && pressed) {
        go(now == 2 * CLICKS ? WAITING : now + 1);
    } else if (!in_press && now > 0 && waited_ns > max_space_ns) {
        only[now / 2 - 1].start();
        go(0);
    }
}

}  // namespace mw::components

MW_COMPONENT(mw::components::Multiclick, "multiclick", mw::sdk::MANY);

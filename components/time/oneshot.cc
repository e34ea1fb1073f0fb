// SPDX-License-Identifier: GPL-2.0-or-later
// oneshot: `out` (bit) is true for `width` seconds (float pin) after an edge of `in`; `out-not` is its
// opposite.
// Parameters `rising` (true at start) and `falling` select the edges; with `retriggerable` (true at start) an
// edge during the pulse restarts it. `reset` (bit) ends it. `time-left` is the remaining time [s].
#include "hal/sdk/component.hh"

namespace mw::components {
using namespace sdk;

struct Oneshot {
    In<bool> in, reset;
    Out<bool> out, out_not;
    In<double> width;
    Out<double> time_left;
    ParamRw<bool> retriggerable, rising, falling;
    bool last_in = false;

    void declare(Declare &d) noexcept {
        d.pin(in, "in");
        d.pin(reset, "reset");
        d.pin(out, "out");
        d.pin(out_not, "out-not");
        d.pin(width, "width");
        d.pin(time_left, "time-left");
        d.param(retriggerable, "retriggerable", true);
        d.param(rising, "rising", true);
        d.param(falling, "falling");
        d.function<&Oneshot::update>(this);
    }

    void update(long period_ns) noexcept {
        if (reset) {
            // An input that is still true when the reset ends counts as an edge.
            last_in = false;
            out = false;
            out_not = true;
            return;
        }
        const bool input = in;
        const bool is_edge = input != last_in && (input ? rising : falling);
        last_in = input;
        double left = out ? time_left - static_cast<double>(period_ns) * 1e-9 : 0.0;
        left = left > 0.0 ? left : 0.0;
        if (is_edge && (retriggerable || left == 0.0)) {
            left = width;
        }
        time_left = left;
        out = left > 0.0;
        out_not = left <= 0.0;
    }
};

}  // namespace mw::components

MW_COMPONENT(mw::components::Oneshot, "oneshot", mw::sdk::MANY);

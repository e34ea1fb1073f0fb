// SPDX-License-Identifier: GPL-2.0-or-later
// timedelay: `out` (bit) becomes true when `in` has been true for `on-delay` seconds, and false when it has
// been false for `off-delay` seconds (floats, 0.5 at start). `elapsed` is the current or last elapsed time
// [s].
#include "hal/sdk/component.hh"

namespace mw::components {
using namespace sdk;

struct Timedelay {
    In<bool> in;
    Out<bool> out;
    In<double> on_delay, off_delay;
    Out<double> elapsed;
    bool last_in = false;

    void declare(Declare &d) noexcept {
        d.pin(in, "in");
        d.pin(out, "out");
        d.pin(on_delay, "on-delay", 0.5);
        d.pin(off_delay, "off-delay", 0.5);
        d.pin(elapsed, "elapsed");
        d.function<&Timedelay::update>(this);
    }

    void update(long period_ns) noexcept {
        const bool input = in;
        const bool changed = input != last_in;
        last_in = input;
        if (input == out.get()) {
            return;
        }
        const double limit = input ? on_delay : off_delay;
        const double waited = (changed ? 0.0 : elapsed.get()) + static_cast<double>(period_ns) * 1e-9;
        elapsed = waited;
        if (waited >= limit) {
            out = input;
        }
    }
};

}  // namespace mw::components

MW_COMPONENT(mw::components::Timedelay, "timedelay", mw::sdk::MANY);

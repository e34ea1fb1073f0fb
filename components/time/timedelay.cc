// SPDX-License-Identifier: GPL-2.0-or-later
// timedelay: `out` (bit) becomes true when `in` has been true for `on-delay` seconds, and false when it has
// been false for `off-delay` seconds (floats, 0.5 at start). `elapsed` is the time waited so far [s].
#include "components/common/kit.hh"

namespace mw::components {

struct Timedelay {
    In<bool> in;
    Out<bool> out;
    In<double> on_delay, off_delay;
    Out<double> elapsed;

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
        if (input == out.get()) {
            elapsed = 0.0;
            return;
        }
        const double waited = elapsed + static_cast<double>(period_ns) * 1e-9;
        elapsed = waited;
        if (waited >= (input ? on_delay : off_delay)) {
            out = input;
            elapsed = 0.0;
        }
    }
};

}  // namespace mw::components

MW_INSTANCES(Timedelay, "timedelay");

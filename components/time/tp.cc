// SPDX-License-Identifier: GPL-2.0-or-later
// tp: the pulse timer of IEC 61131-3. A rising edge of `in` (bit) makes `q` (bit) true for the time of the
// parameter `pt` (float) [s], rounded up to periods.
//
// `et` (float) [s] is the time since the start of the pulse, and 0 from the second period after its end on.
// Edges during a pulse have no effect. A pt that is not above 0 makes no pulse. An input that is true in the
// first period starts one.
#include "hal/sdk/component.hh"

namespace mw::components {
using namespace sdk;

struct PulseTimer {
    In<bool> in;
    Out<bool> q;
    Out<double> et;
    ParamRw<double> pt;
    bool last_in = false;

    void declare(Declare &d) noexcept {
        d.pin(in, "in");
        d.pin(q, "q");
        d.pin(et, "et");
        d.param(pt, "pt");
        d.function<&PulseTimer::update>(this);
    }

    void update(long period_ns) noexcept {
        const bool input = in;
        const bool has_risen = input && !last_in;
        last_in = input;
        const double width = pt;
        const double elapsed = et;
        if (q) {
            const bool is_over = !(elapsed < width);
            q = !is_over;
            et = is_over ? elapsed : elapsed + seconds(period_ns);
        } else if (has_risen && width > 0.0) {
            q = true;
            et = seconds(period_ns);
        } else {
            et = 0.0;
        }
    }
};

}  // namespace mw::components

MW_COMPONENT(mw::components::PulseTimer, "tp", mw::sdk::MANY);

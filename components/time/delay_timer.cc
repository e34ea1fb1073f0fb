// SPDX-License-Identifier: GPL-2.0-or-later
// ton, tof: the timers of IEC 61131-3. The parameter `pt` (float) [s] is the delay.
// ton: `q` (bit) becomes true when `in` has been true for pt, and false when in becomes false. tof: q becomes
// true with in,
// and false when in has been false for pt. `et` (float) [s] is the elapsed time, up to pt. Built
// twice (TIMER_MODULE, TIMER_WAITS_FOR: the state of in that is timed).
#include "hal/sdk/component.hh"

namespace mw::components {
using namespace sdk;

struct DelayTimer {
    In<bool> in;
    Out<bool> q;
    Out<double> et;
    ParamRw<double> pt;

    void declare(Declare &d) noexcept {
        d.pin(in, "in");
        d.pin(q, "q");
        d.pin(et, "et");
        d.param(pt, "pt");
        d.function<&DelayTimer::update>(this);
    }

    void update(long period_ns) noexcept {
        const double delay = pt;
        const double waited = et;
        if (in.get() != TIMER_WAITS_FOR) {
            et = 0.0;
            q = !TIMER_WAITS_FOR;
        } else if (waited < delay) {
            et = waited + seconds(period_ns);
        } else {
            q = TIMER_WAITS_FOR;
        }
    }
};

}  // namespace mw::components

MW_COMPONENT(mw::components::DelayTimer, TIMER_MODULE, mw::sdk::MANY);

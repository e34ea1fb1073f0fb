// SPDX-License-Identifier: GPL-2.0-or-later
// estop_latch: latches a fault until the fault has cleared and a person resets it. Starts in the faulted
// state.
// Pins (bit): `ok-in` (true at start) and `fault-in` are the state of the chain; a rising edge of `reset`
// clears the fault if ok-in is true and fault-in false. `ok-out` and `fault-out` are the state;
// `watchdog` toggles with every call while ok. Software can only support an emergency stop chain; it cannot
// replace one.
#include "hal/sdk/component.hh"

namespace mw::components {
using namespace sdk;

struct EstopLatch {
    In<bool> ok_in, fault_in, reset;
    Out<bool> ok_out, fault_out, watchdog;
    bool last_reset = false;

    void declare(Declare &d) noexcept {
        d.pin(ok_in, "ok-in", true);
        d.pin(fault_in, "fault-in");
        d.pin(reset, "reset");
        d.pin(ok_out, "ok-out");
        d.pin(fault_out, "fault-out", true);
        d.pin(watchdog, "watchdog");
        d.function<&EstopLatch::update>(this);
    }

    void update() noexcept {
        const bool is_reset = reset;
        const bool healthy = ok_in && !fault_in;
        const bool released = ok_out || (is_reset && !last_reset);
        const bool ok = healthy && released;
        last_reset = is_reset;
        ok_out = ok;
        fault_out = !ok;
        if (ok) {
            watchdog = !watchdog;
        }
    }
};

}  // namespace mw::components

MW_COMPONENT(mw::components::EstopLatch, "estop_latch", mw::sdk::MANY);

// SPDX-License-Identifier: GPL-2.0-or-later
// estop_latch: keeps a fault until it is gone and somebody resets it. Starts in the faulted state.
//
// Pins (bit): `ok-in` (true at start) and `fault-in` tell the state of the chain; a rising edge of `reset`
// leaves the faulted state when ok-in is true and fault-in false. `ok-out` and `fault-out` are the state;
// `watchdog` toggles with every call while ok. Software can only help an emergency stop chain; it is not one.
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
        const bool isReset = reset;
        const bool isHealthy = ok_in && !fault_in;
        const bool isReleased = ok_out || (isReset && !last_reset);
        const bool isOk = isHealthy && isReleased;
        last_reset = isReset;
        ok_out = isOk;
        fault_out = !isOk;
        if (isOk) {
            watchdog = !watchdog;
        }
    }
};

}  // namespace mw::components

MW_COMPONENT(mw::components::EstopLatch, "estop_latch", mw::sdk::MANY);

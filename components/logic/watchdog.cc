// SPDX-License-Identifier: GPL-2.0-or-later
// watchdog: checks that 1 to 32 inputs (`num_inputs=`) keep changing.
// `watchdog.ok-out` (bit) is true while `watchdog.enable-in` (bit) is, until `watchdog.input-N` (bit) has not
// changed for longer than the parameter `watchdog.timeout-N` (float) [s] (0 or less, or not a number: never
// ok). After that it stays false until enable-in becomes false and true again. Functions: watchdog.process
// checks (fast thread); watchdog.set-timeouts applies timeouts and restarts (servo thread).
#include <cmath>

#include "hal/sdk/component.hh"

static int num_inputs = 0;
RTAPI_MP_INT(num_inputs, "number of inputs");

namespace mw::components {
using namespace sdk;

constexpr int MAX_INPUTS = 32;

struct WatchedInput {
    In<bool> in;
    ParamRw<double> timeout;
    std::int64_t timeout_ns = 0;
    std::int64_t waited_ns = 0;
    bool last = false;
};

struct Watchdog {
    WatchedInput input[MAX_INPUTS];
    In<bool> enable;
    Out<bool> ok;
    bool armed = false;  // enable-in was true at the last set-timeouts
    bool isBroken = true;

    int load(int comp_id) noexcept {
        if (num_inputs < 1 || num_inputs > MAX_INPUTS) {
            rtapi_print_msg(RTAPI_MSG_ERR, "watchdog: num_inputs=%d, possible are 1 to %d", num_inputs,
                            MAX_INPUTS);
            return -EINVAL;
        }
        Declare d(comp_id, "watchdog", 0);
        for (int i = 0; i < num_inputs; ++i) {
            d.pin_at(input[i].in, "input-%d", i);
            d.param_at(input[i].timeout, "timeout-%d", i);
        }
        d.pin(ok, "ok-out");
        d.pin(enable, "enable-in");
        d.function<&Watchdog::process>(this, "process");
        d.function<&Watchdog::set_timeouts>(this, "set-timeouts");
        return d.status();
    }

    void process(long period_ns) noexcept {
        for (int i = 0; i < num_inputs; ++i) {
            WatchedInput &watched = input[i];
            const bool now = watched.in;
            watched.waited_ns = now == watched.last ? watched.waited_ns + period_ns : 0;
            watched.last = now;
            isBroken = isBroken || watched.waited_ns > watched.timeout_ns;
        }
        ok = enable && armed && !isBroken;
    }

    void set_timeouts() noexcept {
        bool possible = true;
        for (int i = 0; i < num_inputs; ++i) {
            const double wanted = input[i].timeout;
            const bool valid = wanted > 0.0 && wanted < 1e9;
            input[i].timeout_ns = valid ? static_cast<std::int64_t>(wanted * 1e9) : 0;
            possible = possible && valid;
        }
        const bool enabled = enable;
        if (enabled && !armed) {
            isBroken = false;
            for (int i = 0; i < num_inputs; ++i) {
                input[i].waited_ns = 0;
            }
        }
        armed = enabled;
        isBroken = isBroken || !possible || !enabled;
    }
};

}  // namespace mw::components

MW_COMPONENT_SINGLE(mw::components::Watchdog, "watchdog");

// SPDX-License-Identifier: GPL-2.0-or-later
// filter_kalman: the Kalman filter of one number. `xk-out` estimates the constant value of the noisy input
// `zk`
// (float).
// Parameters (float): `qk`, the variance by which the true value may change in a period, and `rk`, the
// variance of the noise (old names Qk, Rk; both 1.17549e-38 at start). `passthrough` (bit) copies zk to
// xk-out and pauses the filter. `reset` (bit) has priority: xk-out is 0 and the filter restarts with
// variance 1. `debug` (bit) logs zk and xk-out.
#include <cmath>

#include "hal/sdk/component.hh"

namespace mw::components {
using namespace sdk;

struct FilterKalman {
    In<bool> debug, passthrough, reset;
    In<double> zk;
    Out<double> xk_out;
    ParamRw<double> rk, qk;
    double estimate = 0.0;
    double variance = 1.0;

    void declare(Declare &d) noexcept {
        constexpr double SMALLEST = 1.17549e-38;
        d.pin(debug, "debug");
        d.pin(passthrough, "passthrough");
        d.pin(reset, "reset");
        d.pin(zk, "zk");
        d.pin(xk_out, "xk-out");
        d.legacy_param(rk, "rk", "Rk", SMALLEST);
        d.legacy_param(qk, "qk", "Qk", SMALLEST);
        d.function<&FilterKalman::update>(this);
    }

    void update() noexcept {
        const double measured = zk;
        if (reset) {
            estimate = 0.0;
            variance = 1.0;
            xk_out = 0.0;
        } else if (passthrough) {
            xk_out = measured;
        } else if (std::isfinite(measured)) {
            xk_out = filtered(measured);
        }
        if (debug) {
            rtapi_print_msg(RTAPI_MSG_INFO, "filter_kalman: zk %g xk-out %g", measured, xk_out.get());
        }
    }

  private:
    double filtered(double measured) noexcept {
        const double predicted = variance + qk;
        const double total = predicted + rk;
        const double gain = total > 0.0 ? predicted / total : 1.0;
        estimate += gain * (measured - estimate);
        variance = (1.0 - gain) * predicted;
        return estimate;
    }
};

}  // namespace mw::components

MW_COMPONENT(mw::components::FilterKalman, "filter_kalman", mw::sdk::MANY);

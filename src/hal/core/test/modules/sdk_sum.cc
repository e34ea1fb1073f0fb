// SPDX-License-Identifier: GPL-2.0-or-later
// A C++ component that uses every feature of the SDK.
#include "hal/sdk/component.hh"

namespace {

struct Sum {
    mw::sdk::In<double> in[2];
    mw::sdk::Out<double> out;
    mw::sdk::InOut<bool> clear;
    mw::sdk::ParamRw<double> gain;
    mw::sdk::ParamRo<std::int32_t> runs;

    void declare(mw::sdk::Declare &d) {
        for (int i = 0; i < 2; ++i) {
            d.pin_at(in[i], "in%d", i);
        }
        d.pin(out, "out");
        d.pin(clear, "clear", true);
        d.param(gain, "gain", 1.0);
        d.param(runs, "runs");
        d.function<&Sum::update>(this);
        d.function<&Sum::hold>(this, "hold");
    }
    void update() noexcept {
        out = gain * (in[0] + in[1]);
        runs = runs + 1;
    }
    void hold(long period_ns) noexcept { out = static_cast<double>(period_ns); }
};

}  // namespace

MW_COMPONENT(Sum, "sdk_sum", 4);

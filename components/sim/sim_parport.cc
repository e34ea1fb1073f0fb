// SPDX-License-Identifier: GPL-2.0-or-later
// sim_parport: the pins of a parallel port without the port. Load it with names=parport.0.
//
// Function N.read: `pin-NN-in` is `pin-NN-in-fake` and `pin-NN-in-not` its inverse. N.write:
// `pin-NN-out-fake` is `pin-NN-out`, inverted while the parameter `pin-NN-out-invert` is true. N.reset,
// `reset-time` and `pin-NN-out-reset` have no effect. The pins of all inputs and outputs exist
// in both directions of the port. All are bit except reset-time.
#include "hal/sdk/canonical.hh"

namespace mw::components {
using namespace sdk;

constexpr int OUTPUT_NUMBERS[] = {1, 2, 3, 4, 5, 6, 7, 8, 9, 14, 16, 17};
constexpr int INPUT_NUMBERS[] = {2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 15};
constexpr int OUTPUTS = sizeof OUTPUT_NUMBERS / sizeof OUTPUT_NUMBERS[0];
constexpr int INPUTS = sizeof INPUT_NUMBERS / sizeof INPUT_NUMBERS[0];

struct SimParport {
    DigitalOut out[OUTPUTS];
    Out<bool> out_fake[OUTPUTS];
    ParamRw<bool> out_reset[OUTPUTS];
    DigitalIn in[INPUTS];
    In<bool> in_fake[INPUTS];
    In<double> reset_time;

    void declare(Declare &d) noexcept {
        for (int i = 0; i < OUTPUTS; ++i) {
            out[i].declare(d, numbered("pin-%02d-", OUTPUT_NUMBERS[i]).text, {.invert = "out-invert"});
            d.pin_at(out_fake[i], "pin-%02d-out-fake", OUTPUT_NUMBERS[i]);
            d.param_at(out_reset[i], "pin-%02d-out-reset", OUTPUT_NUMBERS[i]);
        }
        for (int i = 0; i < INPUTS; ++i) {
            in[i].declare(d, numbered("pin-%02d-", INPUT_NUMBERS[i]).text);
            d.pin_at(in_fake[i], "pin-%02d-in-fake", INPUT_NUMBERS[i]);
        }
        d.pin(reset_time, "reset-time");
        d.function<&SimParport::read>(this, "read");
        d.function<&SimParport::write>(this, "write");
        d.function<&SimParport::reset>(this, "reset");
    }

    void read() noexcept {
        for (int i = 0; i < INPUTS; ++i) {
            in[i].read(in_fake[i]);
        }
    }
    void write() noexcept {
        for (int i = 0; i < OUTPUTS; ++i) {
            out_fake[i] = out[i].write();
        }
    }
    void reset() noexcept {}
};

}  // namespace mw::components

MW_COMPONENT(mw::components::SimParport, "sim_parport", mw::sdk::MANY);

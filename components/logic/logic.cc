// SPDX-License-Identifier: GPL-2.0-or-later
// logic: and, or, xor, nand and nor of up to 16 inputs.
//
// `personality=` lists one number for each instance: the number of inputs (low byte) plus 0x100 for output
// `and`, 0x200 `or`, 0x400 `xor` (an odd number of inputs is true), 0x800 `nand`, 0x1000 `nor`. Pins: in-00,
// in-01, ... and the selected outputs.
#include "hal/sdk/component.hh"

static int personality[mw::sdk::MANY];
RTAPI_MP_ARRAY_INT(personality, mw::sdk::MANY, "inputs and outputs of each instance");

namespace mw::components {
using namespace sdk;

constexpr int MAX_INPUTS = 16;
constexpr int OUTPUTS = 5;
constexpr const char *OUTPUT_NAMES[OUTPUTS] = {"and", "or", "xor", "nand", "nor"};

struct Logic {
    In<bool> in[MAX_INPUTS];
    Out<bool> out[OUTPUTS];
    int inputs = 0;
    bool has_output[OUTPUTS] = {};

    void declare(Declare &d) noexcept {
        const int wanted = personality[d.index()];
        inputs = wanted & 0xff;
        if (inputs < 1 || inputs > MAX_INPUTS) {
            rtapi_print_msg(RTAPI_MSG_ERR, "logic: personality 0x%x of instance %d needs 1 to %d inputs",
                            static_cast<unsigned>(wanted), d.index(), MAX_INPUTS);
            d.keep(-EINVAL);
            return;
        }
        for (int i = 0; i < inputs; ++i) {
            char name[16];
            rtapi_snprintf(name, sizeof name, "in-%02d", i);
            d.pin(in[i], name);
        }
        for (int i = 0; i < OUTPUTS; ++i) {
            has_output[i] = (wanted & (0x100 << i)) != 0;
            if (has_output[i]) {
                d.pin(out[i], OUTPUT_NAMES[i]);
            }
        }
        d.function<&Logic::update>(this);
    }

    void update() noexcept {
        int trues = 0;
        for (int i = 0; i < inputs; ++i) {
            trues += in[i] ? 1 : 0;
        }
        const bool all = trues == inputs;
        const bool any = trues > 0;
        const bool values[OUTPUTS] = {all, any, (trues & 1) != 0, !all, !any};
        for (int i = 0; i < OUTPUTS; ++i) {
            if (has_output[i]) {
                out[i] = values[i];
            }
        }
    }
};

}  // namespace mw::components

MW_COMPONENT(mw::components::Logic, "logic", mw::sdk::MANY);

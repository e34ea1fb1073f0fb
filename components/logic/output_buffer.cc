// SPDX-License-Identifier: GPL-2.0-or-later
// output_buffer: outputs behind one switch: `out-N` (bit) is `in-N` (bit) while `enable` (bit) is true, else
// false; `personality=` gives the number of channels of each instance, up to 32 (the default).
#include "hal/sdk/component.hh"

MW_PERSONALITY("channels of each instance");

namespace mw::components {
using namespace sdk;

struct OutputBuffer {
    static constexpr int MAX_CHANNELS = 32;
    int channels = 0;
    In<bool> enable;
    In<bool> in[MAX_CHANNELS];
    Out<bool> out[MAX_CHANNELS];

    void declare(Declare &d) noexcept {
        channels = d.personality_number(personality[d.index()], MAX_CHANNELS, MAX_CHANNELS, "channels");
        d.pin(enable, "enable");
        for (int i = 0; i < channels; ++i) {
            d.pin_at(in[i], "in-%d", i);
            d.pin_at(out[i], "out-%d", i);
        }
        d.function<&OutputBuffer::update>(this);
    }

    void update() noexcept {
        const bool enabled = enable;
        for (int i = 0; i < channels; ++i) {
            out[i] = enabled && in[i];
        }
    }
};

}  // namespace mw::components

MW_COMPONENT(mw::components::OutputBuffer, "output_buffer", mw::sdk::MANY);

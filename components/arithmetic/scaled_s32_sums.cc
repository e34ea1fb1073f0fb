// SPDX-License-Identifier: GPL-2.0-or-later
// scaled_s32_sums: `out-f` is the sum of `in0` to `in3` (s32), each times its `scale0` to `scale3` (float, 1
// at start); `out-s` (s32) is its whole part, the nearest possible when it does not fit.
#include "components/conv/conv_core.hh"
#include "hal/sdk/component.hh"

namespace mw::components {
using namespace sdk;

struct ScaledS32Sums {
    static constexpr int INPUTS = 4;
    In<std::int32_t> in[INPUTS];
    In<double> scale[INPUTS];
    Out<std::int32_t> out_s;
    Out<double> out_f;

    void declare(Declare &d) noexcept {
        for (int i = 0; i < INPUTS; ++i) {
            d.pin_at(in[i], "in%d", i);
            d.pin_at(scale[i], "scale%d", i, 1.0);
        }
        d.pin(out_s, "out-s");
        d.pin(out_f, "out-f");
        d.function<&ScaledS32Sums::update>(this);
    }

    void update() noexcept {
        double sum = 0.0;
        for (int i = 0; i < INPUTS; ++i) {
            sum += in[i] * scale[i];
        }
        out_f = sum;
        out_s = conv::convert<std::int32_t>(sum, true).value;
    }
};

}  // namespace mw::components

MW_COMPONENT(mw::components::ScaledS32Sums, "scaled_s32_sums", mw::sdk::MANY);

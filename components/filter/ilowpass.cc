// SPDX-License-Identifier: GPL-2.0-or-later
// ilowpass: a low-pass filter between integers, to smooth the counts of a hand wheel.
//
// `out` (s32) follows `in` (s32) times `scale` (1024 at start), going the part `gain` (0.5 at start, 0 to 1)
// of the way in every period. Divide what follows by `scale`. Both are parameters.
#include <cmath>

#include "components/common/kit.hh"
#include "components/conv/conv_core.hh"

namespace mw::components {

struct Ilowpass {
    In<std::int32_t> in;
    Out<std::int32_t> out;
    ParamRw<double> scale, gain;
    double value = 0.0;

    void declare(Declare &d) noexcept {
        d.pin(in, "in");
        d.pin(out, "out");
        d.param(scale, "scale", 1024.0);
        d.param(gain, "gain", 0.5);
        d.function<&Ilowpass::update>(this);
    }

    void update() noexcept {
        value += (in * scale - value) * gain;
        out = conv::clamped<std::int32_t>(std::floor(value + 0.5)).value;
    }
};

}  // namespace mw::components

MW_INSTANCES(Ilowpass, "ilowpass");

// SPDX-License-Identifier: GPL-2.0-or-later
// abs, abs_s32, abs_s64: `out` is the absolute value of `in`. `sign` and `is-negative` (bit) are true below
// zero, `is-positive` above. The value that has no positive counterpart becomes the largest one.
// Built once for each type (ABS_TYPE, ABS_MODULE).
#include <limits>

#include "hal/sdk/component.hh"

namespace mw::components {
using namespace sdk;

struct Abs {
    In<ABS_TYPE> in;
    Out<ABS_TYPE> out;
    Out<bool> sign, is_positive, is_negative;

    void declare(Declare &d) noexcept {
        d.pin(in, "in");
        d.pin(out, "out");
        d.pin(sign, "sign");
        d.pin(is_positive, "is-positive");
        d.pin(is_negative, "is-negative");
        d.function<&Abs::update>(this);
    }

    void update() noexcept {
        using Limits = std::numeric_limits<ABS_TYPE>;
        const ABS_TYPE value = in;
        const bool is_lowest = Limits::is_integer && value == Limits::lowest();
        out = is_lowest ? Limits::max() : (value < 0 ? -value : value);
        sign = value < 0;
        is_positive = value > 0;
        is_negative = value < 0;
    }
};

}  // namespace mw::components

MW_COMPONENT(mw::components::Abs, ABS_MODULE, mw::sdk::MANY);

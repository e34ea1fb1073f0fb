// SPDX-License-Identifier: GPL-2.0-or-later
// abs: `out` is the absolute value of `in` (float). `sign` and `is-negative` (bit) are true below zero,
// `is-positive` above.
#include <cmath>

#include "components/common/kit.hh"

namespace mw::components {

struct Abs {
    In<double> in;
    Out<double> out;
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
        const double value = in;
        out = std::fabs(value);
        sign = value < 0.0;
        is_positive = value > 0.0;
        is_negative = value < 0.0;
    }
};

}  // namespace mw::components

MW_INSTANCES(Abs, "abs");

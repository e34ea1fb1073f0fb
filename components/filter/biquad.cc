// SPDX-License-Identifier: GPL-2.0-or-later
// biquad: a second-order filter, H(z) = (n0 + n1/z + n2/z^2) / (1 + d1/z + d2/z^2).
// While `enable` (bit) is false, `out` is `in`. When it becomes true, `type` (u32) selects the
// coefficients: 0 the parameters n0 n1 n2 d1 d2, 1 a low-pass, 2 a notch at `f0` [Hz] with quality
// `q` (old name Q); with 1 and 2 the filter starts with zero state. `valid` (bit) is false if that is not
// possible (f0 must be below half of the sample rate, q from 0.5 to 2): `out` is then `in`. s1, s2: internal
// state. Coefficients: R. Bristow-Johnson, "Cookbook formulae for audio EQ biquad filter coefficients". The
// structure is the transposed direct form II.
#include <cmath>
#include <numbers>

#include "hal/sdk/component.hh"

namespace mw::components {
using namespace sdk;

struct Biquad {
    In<double> in, f0, q;
    Out<double> out, s1, s2;
    In<bool> enable;
    Out<bool> valid;
    In<std::uint32_t> type;
    ParamRw<double> d1, d2, n0, n1, n2;
    bool was_enabled = false;

    void declare(Declare &d) noexcept;
    void update(long period_ns) noexcept;

  private:
    bool design(double period_s) noexcept;
};

void Biquad::declare(Declare &d) noexcept {
    d.pin(in, "in");
    d.pin(out, "out");
    d.pin(enable, "enable");
    d.pin(valid, "valid");
    d.pin(type, "type");
    d.pin(f0, "f0", 250.0);
    d.legacy_pin(q, "q", "Q", 0.7071);
    d.pin(s1, "s1");
    d.pin(s2, "s2");
    d.param(d1, "d1");
    d.param(d2, "d2");
    d.param(n0, "n0", 1.0);
    d.param(n1, "n1");
    d.param(n2, "n2");
    d.function<&Biquad::update>(this);
}

bool Biquad::design(double period_s) noexcept {
    const std::uint32_t kind = type;
    if (kind == 0) {
        return true;
    }
    const double quality = q;
    const double frequency = f0;
    const bool possible =
        kind <= 2 && quality >= 0.5 && quality <= 2.0 && frequency > 0.0 && frequency * period_s < 0.5;
    if (!possible) {
        return false;
    }
    const double angle = 2.0 * std::numbers::pi * frequency * period_s;
    const double cosine = std::cos(angle);
    const double alpha = std::sin(angle) / (2.0 * quality);
    const double scale = 1.0 / (1.0 + alpha);
    n0 = kind == 1 ? 0.5 * (1.0 - cosine) * scale : scale;
    n1 = kind == 1 ? (1.0 - cosine) * scale : -2.0 * cosine * scale;
    n2 = n0.get();
    d1 = -2.0 * cosine * scale;
    d2 = (1.0 - alpha) * scale;
    s1 = 0.0;
    s2 = 0.0;
    return true;
}

void Biquad::update(long period_ns) noexcept {
    const double input = in;
    const bool enabled = enable;
    if (enabled && !was_enabled) {
        valid = design(seconds(period_ns));
    }
    was_enabled = enabled;
    if (!enabled || !valid || !std::isfinite(input)) {
        out = input;
        return;
    }
    const double filtered = n0 * input + s1;
    s1 = n1 * input - d1 * filtered + s2;
    s2 = n2 * input - d2 * filtered;
    out = filtered;
}

}  // namespace mw::components

MW_COMPONENT(mw::components::Biquad, "biquad", mw::sdk::MANY);

// SPDX-License-Identifier: GPL-2.0-or-later
// ilowpass: a low-pass filter for integers, to smooth the counts of a hand wheel.
// `out` (s32) follows `in` (s32) times `scale` (1024 at start). In every period it moves by the fraction
// `gain`
// (0.5 at start, 0 to 1) of the difference. Divide the scale of the following component by `scale`. Both are
// parameters. Components that read counts use their differences, so both values wrap at 32 bits instead of
// stopping.
#include <cmath>

#include "hal/sdk/component.hh"

namespace mw::components {
using namespace sdk;

/// `value` rounded to the nearest integer, modulo 2^32.
static std::int32_t wrapped(double value) noexcept {
    const double rest = std::fmod(std::floor(value + 0.5), 4294967296.0);
    return static_cast<std::int32_t>(static_cast<std::uint32_t>(static_cast<std::int64_t>(rest)));
}

struct Ilowpass {
    In<std::int32_t> in;
    Out<std::int32_t> out;
    ParamRw<double> scale, gain;
    std::int32_t last_in = 0;
    std::int64_t counts = 0;  ///< `in` without the jumps from the wrap of its type
    double value = 0.0;       ///< [counts * scale]

    void declare(Declare &d) noexcept {
        d.pin(in, "in");
        d.pin(out, "out");
        d.param(scale, "scale", 1024.0);
        d.param(gain, "gain", 0.5);
        d.function<&Ilowpass::update>(this);
    }

    void update() noexcept {
        const std::int32_t now = in;
        counts +=
            static_cast<std::int32_t>(static_cast<std::uint32_t>(now) - static_cast<std::uint32_t>(last_in));
        last_in = now;
        const double next = value + (static_cast<double>(counts) * scale - value) * gain;
        value = std::isfinite(next) ? next : value;
        out = wrapped(value);
    }
};

}  // namespace mw::components

MW_COMPONENT(mw::components::Ilowpass, "ilowpass", mw::sdk::MANY);

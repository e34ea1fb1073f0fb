// SPDX-License-Identifier: GPL-2.0-or-later
// siggen: sine, cosine, triangle, sawtooth and square waves, up to 16 channels (`num_chan=`, 1 by default, or
// `names=`).
// Function siggen.N.update. Pins (float): frequency [Hz] and amplitude (1 at start), offset; outputs square,
// sine, cosine, triangle, sawtooth; clock (bit) is true in the rising half of triangle; reset (bit) keeps the
// outputs at the middle of the period.
#include "components/siggen/siggen_core.hh"
#include "hal/sdk/component.hh"

namespace mw::components {
using namespace sdk;

struct Siggen {
    In<double> frequency, amplitude, offset;
    In<bool> reset;
    Out<bool> clock;
    Out<double> square, sine, cosine, triangle, sawtooth;
    siggen::Generator generator;

    void declare(Declare &d) noexcept {
        d.pin(frequency, "frequency", 1.0);
        d.pin(amplitude, "amplitude", 1.0);
        d.pin(offset, "offset");
        d.pin(reset, "reset");
        d.pin(clock, "clock");
        d.pin(square, "square");
        d.pin(sine, "sine");
        d.pin(cosine, "cosine");
        d.pin(triangle, "triangle");
        d.pin(sawtooth, "sawtooth");
        d.function<&Siggen::update>(this, "update");
    }

    void update(long period_ns) noexcept {
        const siggen::Waves waves =
            generator.run(frequency, amplitude, offset, reset, static_cast<double>(period_ns) * 1e-9);
        clock = waves.clock;
        square = waves.square;
        sine = waves.sine;
        cosine = waves.cosine;
        triangle = waves.triangle;
        sawtooth = waves.sawtooth;
    }
};

}  // namespace mw::components

MW_MODULE("siggen", num_chan, 1, mw::siggen::MAX_CHANNELS, mw::sdk::load_instances<mw::components::Siggen>);

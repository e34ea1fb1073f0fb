// SPDX-License-Identifier: GPL-2.0-or-later
// sim_encoder: quadrature and index signals as of an encoder, up to 8 channels (`num_chan=`, 1 by default, or
// `names=`).
//
// Functions: make-pulses (as often as possible) and update-speed. Pins of sim-encoder.N: speed [units/s];
// scale [units/turn] (I/O, 1 at start); ppr (u32, I/O, 100 at start): pulses a turn, four counts each;
// phase-A, phase-B, phase-Z (bit); rawcounts (s32).
#include <atomic>

#include "components/plants/quadrature_source.hh"
#include "hal/sdk/component.hh"

namespace mw::components {
using namespace sdk;

constexpr int MAX_ENCODERS = 8;

struct SimEncoderChannel {
    In<double> speed;
    InOut<double> scale;
    InOut<std::uint32_t> ppr;
    Out<bool> phase_a, phase_b, phase_z;
    In<std::int32_t> rawcounts;
    plants::QuadratureSource source;

    void declare(Declare &d) noexcept {
        d.pin(speed, "speed");
        d.pin(scale, "scale", 1.0);
        d.pin(ppr, "ppr", 100U);
        d.legacy_pin(phase_a, "phase-a", "phase-A");
        d.legacy_pin(phase_b, "phase-b", "phase-B");
        d.legacy_pin(phase_z, "phase-z", "phase-Z");
        d.pin(rawcounts, "rawcounts");
    }

    void update() noexcept {
        // A scale of zero would mean infinitely many turns.
        const double units = scale != 0.0 ? scale.get() : 1.0;
        const auto counts = static_cast<std::int32_t>(4 * ppr.get());
        source.set_speed(speed / units * counts, counts);
    }

    void run(double dt) noexcept {
        source.run(dt);
        phase_a = source.phase_a();
        phase_b = source.phase_b();
        phase_z = source.index();
        rawcounts = source.counts();
    }
};

struct SimEncoder : Channels<SimEncoderChannel, MAX_ENCODERS> {
    void declare(Declare &d) noexcept {
        d.function<&SimEncoder::make_pulses>(this, "make-pulses");
        d.function<&SimEncoder::update_speed>(this, "update-speed");
    }

    void make_pulses(long period_ns) noexcept {
        for (int i = 0; i < count; ++i) {
            channel[i]->run(static_cast<double>(period_ns) * 1e-9);
        }
    }

    void update_speed() noexcept {
        for (int i = 0; i < count; ++i) {
            channel[i]->update();
        }
    }
};

}  // namespace mw::components

MW_MODULE("sim_encoder", num_chan, 1, mw::components::MAX_ENCODERS,
          mw::sdk::load_channels<mw::components::SimEncoder>);

// SPDX-License-Identifier: GPL-2.0-or-later
// encoder: counts quadrature or single-phase encoder signals in software, up to 8 channels (`num_chan=`, 3 by
// default, or `names=`).
//
// Functions: update-counters (as often as possible) and capture-position (servo thread).
// Pins of encoder.N: phase-A, phase-B, phase-Z (bit); counter-mode (rising edges of A only), x4-mode (every
// edge, else one count a cycle); position-scale [counts/unit]; counts, position, velocity [units/s],
// velocity-rpm [units/min], position-interpolated; min-speed-estimate [units/s], below which velocity is 0;
// index-enable (I/O: the next index sets the position to 0 and this to false); reset; missing-teeth (in
// counter mode: a gap of so many teeth is the index); latch-input, latch-rising, latch-falling,
// counts-latched, position-latched; rawcounts.
#include "components/encoder/encoder_core.hh"
#include "hal/sdk/component.hh"

namespace mw::components {
using namespace sdk;

struct EncoderChannel {
    In<bool> phase_a, phase_b, phase_z, reset, latch_input, latch_rising, latch_falling;
    InOut<bool> counter_mode, x4_mode, index_enable;
    InOut<double> position_scale;
    In<double> min_speed;
    In<std::int32_t> missing_teeth;
    Out<std::int32_t> counts, counts_latched, rawcounts;
    Out<double> position, interpolated, position_latched, velocity, velocity_rpm;

    encoder::FastPart fast;
    encoder::SlowPart slow;

    void declare(Declare &d) noexcept {
        d.legacy_pin(phase_a, "phase-a", "phase-A");
        d.legacy_pin(phase_b, "phase-b", "phase-B");
        d.legacy_pin(phase_z, "phase-z", "phase-Z");
        d.pin(reset, "reset");
        d.pin(latch_input, "latch-input");
        d.pin(latch_rising, "latch-rising", true);
        d.pin(latch_falling, "latch-falling", true);
        d.pin(counter_mode, "counter-mode");
        d.pin(x4_mode, "x4-mode", true);
        d.pin(index_enable, "index-enable");
        d.pin(position_scale, "position-scale", 1.0);
        d.pin(min_speed, "min-speed-estimate", 1.0);
        d.pin(missing_teeth, "missing-teeth");
        d.pin(counts, "counts");
        d.pin(counts_latched, "counts-latched");
        d.pin(rawcounts, "rawcounts");
        d.pin(position, "position");
        d.pin(interpolated, "position-interpolated");
        d.pin(position_latched, "position-latched");
        d.pin(velocity, "velocity");
        d.pin(velocity_rpm, "velocity-rpm");
    }

    void sample(long period_ns) noexcept {
        const encoder::Phases phases{phase_a, phase_b, phase_z, latch_input};
        const encoder::FastSettings settings{counter_mode, x4_mode,       index_enable,
                                             latch_rising, latch_falling, missing_teeth};
        fast.run(phases, settings, period_ns);
        rawcounts = fast.raw();
    }

    void capture() noexcept {
        const encoder::Measured measured = slow.run(fast, {position_scale, min_speed, reset});
        if (measured.indexSeen) {
            index_enable = false;
        }
        counts = measured.counts;
        position = measured.position;
        interpolated = measured.interpolated;
        velocity = measured.velocity;
        velocity_rpm = measured.velocity * 60.0;
        counts_latched = measured.counts_latched;
        position_latched = measured.position_latched;
    }
};

struct Encoder : Channels<EncoderChannel, encoder::MAX_CHANNELS> {
    void declare(Declare &d) noexcept {
        d.function<&Encoder::update_counters>(this, "update-counters");
        d.function<&Encoder::capture_position>(this, "capture-position");
    }

    void update_counters(long period_ns) noexcept {
        for (int i = 0; i < count; ++i) {
            channel[i]->sample(period_ns);
        }
    }

    void capture_position() noexcept {
        for (int i = 0; i < count; ++i) {
            channel[i]->capture();
        }
    }
};

}  // namespace mw::components

MW_MODULE("encoder", num_chan, 3, mw::encoder::MAX_CHANNELS, mw::sdk::load_channels<mw::components::Encoder>);

// SPDX-License-Identifier: GPL-2.0-or-later
// counter: counts the rising edges of one signal, up to 8 channels (`num_chan=`). Kept for old files; encoder
// with counter-mode does the same and more.
//
// Functions: update-counters (as often as possible) and capture-position. Pins of counter.N: phase-A,
// phase-Z, reset (bit), index-enable (I/O), position-scale [counts/unit] (I/O), counts, rawcounts (s32),
// position, velocity [units/s]. Reset sets rawcounts to 0, too; an index does not.
#include <atomic>

#include "components/encoder/encoder_core.hh"
#include "hal/sdk/component.hh"

namespace mw::components {
using namespace sdk;

struct CounterChannel {
    In<bool> phase_a, phase_z, reset;
    InOut<bool> index_enable;
    InOut<double> position_scale;
    Out<std::int32_t> counts, rawcounts;
    Out<double> position, velocity;

    std::atomic<std::int32_t> raw_zero{
        0};  ///< raw count at the last reset; written by capture, read by sample
    encoder::FastPart fast;
    encoder::SlowPart slow;

    void declare(Declare &d) noexcept {
        d.legacy_pin(phase_a, "phase-a", "phase-A");
        d.legacy_pin(phase_z, "phase-z", "phase-Z");
        d.pin(reset, "reset");
        d.pin(index_enable, "index-enable");
        d.pin(position_scale, "position-scale", 1.0);
        d.pin(counts, "counts");
        d.pin(rawcounts, "rawcounts");
        d.pin(position, "position");
        d.pin(velocity, "velocity");
    }

    void sample(long period_ns) noexcept {
        encoder::FastSettings settings;
        settings.is_counter = true;
        settings.isIndexEnabled = index_enable;
        fast.run({phase_a, false, phase_z, false}, settings, period_ns);
        show_raw();
    }

    void capture() noexcept {
        // Without the input for the minimum speed, the velocity becomes 0 after a tenth of a second without a
        // count.
        constexpr double SLOWEST_COUNTS_PER_S = 10.0;
        const double scale = position_scale;
        const double slowest = scale != 0.0 ? SLOWEST_COUNTS_PER_S / (scale < 0.0 ? -scale : scale) : 0.0;
        const encoder::Measured measured = slow.run(fast, {scale, slowest, reset});
        if (measured.indexSeen) {
            index_enable = false;
        }
        if (reset) {
            raw_zero.store(fast.raw(), std::memory_order_relaxed);
            show_raw();
        }
        counts = measured.counts;
        position = measured.position;
        velocity = measured.velocity;
    }

  private:
    void show_raw() noexcept {
        rawcounts =
            static_cast<std::int32_t>(static_cast<std::uint32_t>(fast.raw()) -
                                      static_cast<std::uint32_t>(raw_zero.load(std::memory_order_relaxed)));
    }
};

struct Counter : Channels<CounterChannel, encoder::MAX_CHANNELS> {
    void declare(Declare &d) noexcept {
        d.function<&Counter::update_counters>(this, "update-counters");
        d.function<&Counter::capture_position>(this, "capture-position");
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

MW_MODULE("counter", num_chan, 1, mw::encoder::MAX_CHANNELS, mw::sdk::load_channels<mw::components::Counter>);

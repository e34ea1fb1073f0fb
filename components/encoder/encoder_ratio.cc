// SPDX-License-Identifier: GPL-2.0-or-later
// encoder_ratio: an electronic gear between two quadrature encoders, up to 8 pairs (`num_chan=`, 1 by
// default, or `names=`).
// Functions: sample (as often as possible) and update (servo thread). Pins of encoder-ratio.N: master-A,
// master-B, slave-A, slave-B, enable (bit); error (float, revolutions of the slave): the slave's position
// minus the travel of the master while enabled, times master-teeth / slave-teeth. When enable becomes false,
// the error
// does not jump: the slave keeps its position. master-ppr, slave-ppr (counts per revolution), master-teeth,
// slave-teeth (u32, I/O).
#include "components/encoder/encoder_core.hh"
#include "hal/sdk/component.hh"

namespace mw::components {
using namespace sdk;

struct RatioChannel {
    In<bool> master_a, master_b, slave_a, slave_b, enable;
    Out<double> error;
    InOut<std::uint32_t> master_ppr, slave_ppr, master_teeth, slave_teeth;

    unsigned last_master = 0;
    unsigned last_slave = 0;
    bool first = true;                    ///< the state of the signals in the first period is not a movement
    std::atomic<std::int32_t> master{0};  ///< counts while enabled; written by sample, read by update
    std::atomic<std::int32_t> slave{0};   ///< counts

    void declare(Declare &d) noexcept {
        d.legacy_pin(master_a, "master-a", "master-A");
        d.legacy_pin(master_b, "master-b", "master-B");
        d.legacy_pin(slave_a, "slave-a", "slave-A");
        d.legacy_pin(slave_b, "slave-b", "slave-B");
        d.pin(enable, "enable");
        d.pin(error, "error");
        d.pin(master_ppr, "master-ppr");
        d.pin(slave_ppr, "slave-ppr");
        d.pin(master_teeth, "master-teeth");
        d.pin(slave_teeth, "slave-teeth");
    }

    void sample() noexcept {
        const std::int32_t master_step = change(master_a, master_b, last_master);
        const std::int32_t slave_step = change(slave_a, slave_b, last_slave);
        if (!first && enable) {
            master.fetch_add(master_step, std::memory_order_relaxed);
        }
        if (!first) {
            slave.fetch_add(slave_step, std::memory_order_relaxed);
        }
        first = false;
    }

    void update() noexcept {
        const double master_turns = turns(master.load(std::memory_order_relaxed), master_ppr);
        const double slave_turns = turns(slave.load(std::memory_order_relaxed), slave_ppr);
        const double ratio = static_cast<double>(master_teeth) / at_least_one(slave_teeth);
        error = slave_turns - master_turns * ratio;
    }

  private:
    static double at_least_one(std::uint32_t value) noexcept { return value > 0 ? value : 1.0; }
    static double turns(std::int32_t counts, std::uint32_t ppr) noexcept {
        return counts / at_least_one(ppr);
    }
    static std::int32_t change(bool a, bool b, unsigned &last) noexcept {
        const unsigned now = (a ? 2U : 0U) | (b ? 1U : 0U);
        const std::int32_t step = encoder::quadrature_change(last, now);
        last = now;
        return step;
    }
};

struct EncoderRatio : Channels<RatioChannel, encoder::MAX_CHANNELS> {
    void declare(Declare &d) noexcept {
        d.function<&EncoderRatio::sample>(this, "sample");
        d.function<&EncoderRatio::update>(this, "update");
    }

    void sample() noexcept {
        for (int i = 0; i < count; ++i) {
            channel[i]->sample();
        }
    }

    void update() noexcept {
        for (int i = 0; i < count; ++i) {
            channel[i]->update();
        }
    }
};

}  // namespace mw::components

MW_MODULE("encoder_ratio", num_chan, 1, mw::encoder::MAX_CHANNELS,
          mw::sdk::load_channels<mw::components::EncoderRatio>);

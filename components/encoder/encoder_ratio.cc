// SPDX-License-Identifier: GPL-2.0-or-later
// encoder_ratio: an electronic gear between two quadrature encoders, up to 8 pairs (`num_chan=`, 1 by
// default, or `names=`).
//
// Functions: sample (as often as possible) and update (servo thread). Pins of encoder-ratio.N: master-A,
// master-B, slave-A, slave-B, enable (bit); error (float, turns of the slave): the slave's position, and
// while enabled minus the master's since then times master-teeth / slave-teeth; master-ppr, slave-ppr (pulses
// a turn, four counts each), master-teeth, slave-teeth (u32, I/O).
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
    bool isFirst = true;                  ///< where the signals stand at first is no movement
    std::atomic<std::int32_t> master{0};  ///< counts; written by sample, read by update
    std::atomic<std::int32_t> slave{0};
    std::int32_t master_start = 0;  ///< where the master stood when the gear was engaged

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
        count(master_a, master_b, last_master, master);
        count(slave_a, slave_b, last_slave, slave);
        if (isFirst) {
            isFirst = false;
            master.store(0, std::memory_order_relaxed);
            slave.store(0, std::memory_order_relaxed);
        }
    }

    void update() noexcept {
        const std::int32_t master_now = master.load(std::memory_order_relaxed);
        const double slave_turns = turns(slave.load(std::memory_order_relaxed), slave_ppr);
        if (!enable) {
            master_start = master_now;
        }
        const auto moved = static_cast<std::int32_t>(static_cast<std::uint32_t>(master_now) -
                                                     static_cast<std::uint32_t>(master_start));
        const double ratio = static_cast<double>(master_teeth) / at_least_one(slave_teeth);
        error = slave_turns - turns(moved, master_ppr) * ratio;
    }

  private:
    static double at_least_one(std::uint32_t value) noexcept { return value > 0 ? value : 1.0; }
    static double turns(std::int32_t counts, std::uint32_t ppr) noexcept {
        return counts / at_least_one(ppr);
    }
    static void count(bool a, bool b, unsigned &last, std::atomic<std::int32_t> &counts) noexcept {
        const unsigned now = (a ? 2U : 0U) | (b ? 1U : 0U);
        counts.fetch_add(encoder::quadrature_change(last, now), std::memory_order_relaxed);
        last = now;
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

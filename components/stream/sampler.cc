// SPDX-License-Identifier: GPL-2.0-or-later
// sampler: puts the values of pins into a queue in every period, for halsampler.
//
// `cfg=` has a string for each queue, a letter for each pin (b f s u l k); `depth=` its length in samples.
// Function sampler.N. Pins of sampler.N: pin.M (in); enable (bit, true at start); curr-depth (s32, samples
// waiting); full (bit); overruns (s32, I/O, samples lost); sample-num (s32, I/O, samples tried).
#include "components/stream/stream_pins.hh"
#include "hal/tools/stream/keys.hh"

static int depth[mw::hal::stream_tools::MAX_CHANNELS];
RTAPI_MP_ARRAY_INT(depth, mw::hal::stream_tools::MAX_CHANNELS, "length of each queue [samples]");
static char *cfg[mw::hal::stream_tools::MAX_CHANNELS];
RTAPI_MP_ARRAY_STRING(cfg, mw::hal::stream_tools::MAX_CHANNELS, "letters of the pins of each queue");

namespace mw::components {

struct Sampler {
    StreamPins pins;
    In<bool> enable;
    Out<std::int32_t> curr_depth;
    Out<bool> full;
    InOut<std::int32_t> overruns, sample_num;

    void declare(Declare &d, unsigned queue_depth, const char *config) noexcept {
        pins.declare(d, HAL_IN, hal::stream_tools::SAMPLER_KEY + d.index(), queue_depth, config);
        d.pin(enable, "enable", true);
        d.pin(curr_depth, "curr-depth");
        d.pin(full, "full");
        d.pin(overruns, "overruns");
        d.pin(sample_num, "sample-num");
        d.function<&Sampler::update>(this);
    }

    void update() noexcept {
        if (!enable) {
            return;
        }
        hal_stream_data_u record[HAL_STREAM_MAX_PINS];
        pins.read(record);
        const bool stored = hal_stream_write(&pins.stream, record) >= 0;
        full = !stored;
        if (!stored) {
            overruns = next_count(overruns);
        }
        sample_num = next_count(sample_num);
        curr_depth = static_cast<std::int32_t>(hal_stream_depth(&pins.stream));
    }
};

}  // namespace mw::components

static mw::components::Sampler *samplers[mw::hal::stream_tools::MAX_CHANNELS + 1];
static int mw_comp_id = -1;

int rtapi_app_main(void) {
    mw_comp_id =
        mw::components::load_streams("sampler", depth, cfg, samplers, mw::hal::stream_tools::MAX_CHANNELS);
    return mw_comp_id < 0 ? mw_comp_id : 0;
}

void rtapi_app_exit(void) {
    for (mw::components::Sampler **sampler = samplers; *sampler != nullptr; ++sampler) {
        hal_stream_destroy(&(*sampler)->pins.stream);
    }
    hal_exit(mw_comp_id);
}

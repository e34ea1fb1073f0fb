// SPDX-License-Identifier: GPL-2.0-or-later
// streamer: sets pins to the values that halstreamer has put into a queue, a record in every period.
//
// `cfg=` has a string for each queue, a letter for each pin (b f s u l k); `depth=` its length in records.
// Function streamer.N. Pins of streamer.N: pin.M (out); enable (bit, true at start); clock (bit) and
// clock-mode (s32: 0 every period, 1 at falling, 2 at rising, 3 at any edge of clock); curr-depth (s32,
// records waiting); empty (bit); underruns (s32, I/O, periods without a record).
#include "components/stream/stream_pins.hh"
#include "hal/tools/stream/keys.hh"

static int depth[mw::hal::stream_tools::MAX_CHANNELS];
RTAPI_MP_ARRAY_INT(depth, mw::hal::stream_tools::MAX_CHANNELS, "length of each queue [records]");
static char *cfg[mw::hal::stream_tools::MAX_CHANNELS];
RTAPI_MP_ARRAY_STRING(cfg, mw::hal::stream_tools::MAX_CHANNELS, "letters of the pins of each queue");

namespace mw::components {

enum ClockMode : std::int32_t { EVERY_PERIOD = 0, FALLING_EDGE = 1, RISING_EDGE = 2, ANY_EDGE = 3 };

struct Streamer {
    StreamPins pins;
    In<bool> enable, clock;
    In<std::int32_t> clock_mode;
    Out<std::int32_t> curr_depth;
    Out<bool> empty;
    InOut<std::int32_t> underruns;
    bool last_clock = false;

    void declare(Declare &d, unsigned queue_depth, const char *config) noexcept {
        pins.declare(d, HAL_OUT, hal::stream_tools::STREAMER_KEY + d.index(), queue_depth, config);
        d.pin(enable, "enable", true);
        d.pin(clock, "clock");
        d.pin(clock_mode, "clock-mode");
        d.pin(curr_depth, "curr-depth");
        d.pin(empty, "empty", true);
        d.pin(underruns, "underruns");
        d.function<&Streamer::update>(this);
    }

    void update() noexcept {
        const bool due = isClocked();
        curr_depth = static_cast<std::int32_t>(hal_stream_depth(&pins.stream));
        empty = !hal_stream_readable(&pins.stream);
        if (!enable || !due) {
            return;
        }
        hal_stream_data_u record[HAL_STREAM_MAX_PINS];
        if (hal_stream_read(&pins.stream, record, nullptr) < 0) {
            underruns = next_count(underruns);
            return;
        }
        pins.write(record);
    }

  private:
    bool isClocked() noexcept {
        const bool now = clock;
        const bool rising = now && !last_clock;
        const bool falling = !now && last_clock;
        last_clock = now;
        switch (clock_mode) {
        case FALLING_EDGE: return falling;
        case RISING_EDGE: return rising;
        case ANY_EDGE: return rising || falling;
        default: return true;
        }
    }
};

}  // namespace mw::components

static mw::components::Streamer *streamers[mw::hal::stream_tools::MAX_CHANNELS + 1];
static int mw_comp_id = -1;

int rtapi_app_main(void) {
    mw_comp_id =
        mw::components::load_streams("streamer", depth, cfg, streamers, mw::hal::stream_tools::MAX_CHANNELS);
    return mw_comp_id < 0 ? mw_comp_id : 0;
}

void rtapi_app_exit(void) {
    for (mw::components::Streamer **streamer = streamers; *streamer != nullptr; ++streamer) {
        hal_stream_destroy(&(*streamer)->pins.stream);
    }
    hal_exit(mw_comp_id);
}

// SPDX-License-Identifier: GPL-2.0-or-later
// time: measures how long `start` (bit) has been true: `hours`, `minutes`, `seconds` (u32).
// It starts again at zero when start becomes true, and stops while `pause` (bit) is true. If start
// becomes false during a pause, as a program's "is running" does, the time continues after the pause.
#include "hal/sdk/component.hh"

namespace mw::components {
using namespace sdk;

struct Time {
    In<bool> start, pause;
    Out<std::uint32_t> seconds_pin, minutes, hours;
    std::int64_t elapsed_ns = 0;
    bool wasOn = false;

    void declare(Declare &d) noexcept {
        d.pin(start, "start");
        d.pin(pause, "pause");
        d.pin(seconds_pin, "seconds");
        d.pin(minutes, "minutes");
        d.pin(hours, "hours");
        d.function<&Time::update>(this);
    }

    void update(long period_ns) noexcept {
        constexpr std::int64_t SECOND_NS = 1000000000;
        const bool paused = pause;
        const bool on = start || paused;
        if (on && !wasOn) {
            elapsed_ns = 0;
        }
        if (on && !paused) {
            elapsed_ns += period_ns;
        }
        wasOn = on;
        const std::int64_t whole_s = elapsed_ns / SECOND_NS;
        seconds_pin = static_cast<std::uint32_t>(whole_s % 60);
        minutes = static_cast<std::uint32_t>(whole_s / 60 % 60);
        hours = static_cast<std::uint32_t>(whole_s / 3600);
    }
};

}  // namespace mw::components

MW_COMPONENT(mw::components::Time, "time", mw::sdk::MANY);

// SPDX-License-Identifier: GPL-2.0-or-later
#include "drivers/mesa/board/modules/watchdog.hh"

#include "drivers/mesa/board/clock.hh"

namespace mw::mesa::board {

namespace {

constexpr std::uint32_t OFF = 1U << 31U;
enum : unsigned { TIMER, STATUS, RESET };

}  // namespace

void reset_watchdog(Watchdog &watchdog, std::int64_t tick) {
    if ((watchdog.timer & OFF) != 0) {
        watchdog.bites_tick.reset();
    } else {
        watchdog.bites_tick = tick + watchdog.timer + 1;
    }
}

std::uint32_t WatchdogModule::read(RegisterPlace place) {
    switch (place.reg) {
    case TIMER: return watchdog_.timer;
    case STATUS: return watchdog_.bitten ? 1 : 0;
    default: return 0;
    }
}

void WatchdogModule::write(RegisterPlace place, std::uint32_t value) {
    switch (place.reg) {
    case TIMER: watchdog_.timer = value; break;
    case STATUS: watchdog_.bitten = (value & 1U) != 0; break;
    default:
        if (value == WATCHDOG_RESET) {
            reset_watchdog(watchdog_, ticks_at(time_ns_, clock_hz_));
        }
        break;
    }
}

std::optional<std::int64_t> WatchdogModule::bites_at_ns() const {
    if (!watchdog_.bites_tick.has_value()) {
        return {};
    }
    return time_of_tick(*watchdog_.bites_tick, clock_hz_);
}

void WatchdogModule::bite() {
    watchdog_.bitten = true;
    watchdog_.bites_tick.reset();
}

}  // namespace mw::mesa::board

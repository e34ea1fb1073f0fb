// SPDX-License-Identifier: GPL-2.0-or-later
#include "motion/core/watchdog/watchdog.hh"

namespace mw::motion {

Verdict take(Watchdog &watchdog, const SetWatchdog &command) noexcept {
    if (!(command.timeout_s > 0)) {
        return {Reason::OUT_OF_RANGE};
    }
    watchdog.isOn = command.isOn;
    watchdog.timeout_s = command.timeout_s;
    watchdog.standing_s = 0;
    return {};
}

Verdict take(Watchdog &watchdog, const Heartbeat &) noexcept {
    watchdog.standing_s = 0;
    return {};
}

bool step(Watchdog &watchdog, std::uint64_t loops, bool isDead, double period_s) noexcept {
    watchdog.standing_s = loops != watchdog.loops ? 0 : watchdog.standing_s + period_s;
    watchdog.loops = loops;
    const bool isHung = watchdog.isOn && watchdog.standing_s > watchdog.timeout_s;
    const bool wasLost = watchdog.isLost;
    watchdog.isLost = isDead || isHung;
    return watchdog.isLost && !wasLost;
}

}  // namespace mw::motion

// SPDX-License-Identifier: GPL-2.0-or-later
#include "motion/servo/watchdog/watchdog.hh"

#include <utility>

namespace mw::motion {

CommandResult take(Watchdog &watchdog, const SetWatchdog &command) noexcept {
    if (!(command.timeout_s > 0)) {
        return {Reason::OUT_OF_RANGE};
    }
    watchdog.isOn = command.isOn;
    watchdog.timeout_s = command.timeout_s;
    watchdog.standing_s = watchdog.starved_s = 0;
    return {};
}

CommandResult take(Watchdog &watchdog, const Heartbeat &) noexcept {
    watchdog.standing_s = watchdog.starved_s = 0;
    return {};
}

bool step(Watchdog &watchdog, const TaskSigns &signs, double period_s) noexcept {
    constexpr double LOOK_S = 0.1;  // twice the time between two looks
    constexpr double SHARE_OF_STARVED = 0.25;
    watchdog.unseen_s = signs.looks != watchdog.last.looks ? 0 : watchdog.unseen_s + period_s;
    if (signs.loops != watchdog.last.loops) {
        watchdog.standing_s = watchdog.starved_s = 0;
    } else {
        const bool isStarved = signs.looks != 0 && watchdog.unseen_s > LOOK_S;
        (isStarved ? watchdog.starved_s : watchdog.standing_s) += period_s;
    }
    watchdog.last = signs;
    const double counted_s = watchdog.standing_s + SHARE_OF_STARVED * watchdog.starved_s;
    const bool wasLost = watchdog.isLost;
    watchdog.isLost = signs.isDead || (watchdog.isOn && counted_s > watchdog.timeout_s);
    return watchdog.isLost && !wasLost;
}

double gap_s(Watchdog &watchdog, std::int64_t time_ns) noexcept {
    constexpr std::int64_t LONGEST_NS = 250000000;
    constexpr double S_PER_NS = 1e-9;
    const std::int64_t before_ns = std::exchange(watchdog.last_step_ns, time_ns);
    const std::int64_t gap_ns = time_ns - before_ns;
    return before_ns != 0 && gap_ns > LONGEST_NS ? static_cast<double>(gap_ns) * S_PER_NS : 0;
}

}  // namespace mw::motion

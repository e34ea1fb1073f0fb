// SPDX-License-Identifier: GPL-2.0-or-later
#include "motion/servo/watchdog/watchdog.hh"

#include <utility>

namespace mw::motion {

CommandResult Watchdog::take(const SetWatchdog &command) noexcept {
    if (!(command.timeout_s > 0)) {
        return {Reason::OUT_OF_RANGE};
    }
    on_ = command.isOn;
    timeout_s_ = command.timeout_s;
    silent_s_ = starved_s_ = 0;
    return {};
}

CommandResult Watchdog::take(const Heartbeat &) noexcept {
    silent_s_ = starved_s_ = 0;
    return {};
}

bool Watchdog::step(const TaskSigns &signs, double period_s) noexcept {
    constexpr double LOOK_S = 0.1;  // twice the interval between two checks
    constexpr double SHARE_OF_STARVED = 0.25;
    unseen_s_ = signs.looks != last_.looks ? 0 : unseen_s_ + period_s;
    if (signs.loops != last_.loops) {
        silent_s_ = starved_s_ = 0;
    } else {
        const bool isStarved = signs.looks != 0 && unseen_s_ > LOOK_S;
        (isStarved ? starved_s_ : silent_s_) += period_s;
    }
    last_ = signs;
    const double counted_s = silent_s_ + SHARE_OF_STARVED * starved_s_;
    const bool wasLost = lost_;
    lost_ = signs.isDead || (on_ && counted_s > timeout_s_);
    return lost_ && !wasLost;
}

double Watchdog::gap_s(std::int64_t time_ns) noexcept {
    constexpr std::int64_t LONGEST_NS = 250000000;
    constexpr double S_PER_NS = 1e-9;
    const std::int64_t before_ns = std::exchange(last_step_ns_, time_ns);
    const std::int64_t gap_ns = time_ns - before_ns;
    return before_ns != 0 && gap_ns > LONGEST_NS ? static_cast<double>(gap_ns) * S_PER_NS : 0;
}

}  // namespace mw::motion

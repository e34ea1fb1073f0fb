// SPDX-License-Identifier: GPL-2.0-or-later
#include "drivers/mesa/hostmot2/modules/watchdog.hh"

#include <algorithm>

namespace mw::mesa {

namespace {

constexpr std::uint32_t RESTART = 0x5A000000;
/// Bit 31 of the timer switches the watchdog off.
constexpr std::uint64_t LONGEST = 0x7FFFFFFF;
enum WatchdogRegister { TIMER, STATUS, RESET };

constexpr PinRow<WatchdogPins> WATCHDOG_PINS[] = {
    {"has_bit", Access::IO, &WatchdogPins::has_bit},
    {"timeout_ns", Access::RW, &WatchdogPins::timeout_ns},
};

}  // namespace

std::uint32_t watchdog_timer(std::uint32_t timeout_ns, std::uint32_t clock_hz) noexcept {
    constexpr std::uint64_t NS_PER_S = 1'000'000'000;
    const std::uint64_t clocks = std::uint64_t{timeout_ns} * clock_hz / NS_PER_S;
    return static_cast<std::uint32_t>(std::min(std::max<std::uint64_t>(clocks, 1) - 1, LONGEST));
}

void Watchdog::plan(Registers &registers) {
    status_ = registers.read({module_.address(STATUS), 1}, ReadOrder::WATCHDOG);
    timer_ = registers.write(module_.address(TIMER), WriteOrder::WATCHDOG_SETUP, Send::CHANGED);
    clear_ = registers.write(module_.address(STATUS), WriteOrder::WATCHDOG_SETUP, Send::REQUESTED);
    reset_ = registers.write(module_.address(RESET), WriteOrder::WATCHDOG_RESET, Send::ALWAYS, RESTART);
}

void Watchdog::declare(PinSpace &space) {
    binding_.bind(space, "watchdog", WATCHDOG_PINS, pins_);
}

void Watchdog::read(const Registers &registers, const Cycle &) noexcept {
    binding_.load();
    const bool bitten = (registers.value(status_) & 1U) != 0;
    if (!bitten) {
        armed_ = !pins_.has_bit;
        attempts_ = 0;
    } else if (!pins_.has_bit && (armed_ || attempts_ >= MOST_ATTEMPTS)) {
        pins_.has_bit = true;
        bite_new_ = true;
        armed_ = false;
        attempts_ = 0;
    }
    binding_.store();
}

void Watchdog::write(Registers &registers, const Cycle &cycle) noexcept {
    binding_.load();
    if (pins_.has_bit || has_bit_before_) {
        armed_ = false;  // a user set it, or cleared it
    }
    has_bit_before_ = pins_.has_bit;
    if (!pins_.has_bit && !armed_ && cycle.fresh) {
        ++attempts_;
        registers.request(clear_, 0);  // at the start, and when an operator has cleared has_bit
    }
    registers.set(timer_, watchdog_timer(pins_.timeout_ns, module_.clock_hz));
}

bool Watchdog::take_bite() noexcept {
    const bool is_new = bite_new_;
    bite_new_ = false;
    return is_new;
}

}  // namespace mw::mesa

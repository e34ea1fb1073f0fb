// SPDX-License-Identifier: GPL-2.0-or-later
#include "drivers/mesa/board/modules/rc_pwm.hh"

#include "drivers/mesa/board/clock.hh"

namespace mw::mesa::board {

namespace {

enum : unsigned { WIDTH, RATE };
constexpr std::uint8_t PULSE_PIN = 0x81;
constexpr std::uint32_t WIDTH_MASK = 0xFFFF;
constexpr std::int64_t WIDTH_TICKS = 16, RATE_OFFSET = 2;

}  // namespace

std::uint32_t RcPwmModule::read(RegisterPlace place) {
    return place.reg == WIDTH ? widths_[place.instance] : rate_;
}

void RcPwmModule::write(RegisterPlace place, std::uint32_t value) {
    if (place.reg == WIDTH) {
        widths_[place.instance] = value & WIDTH_MASK;
    } else {
        rate_ = value;
    }
}

std::int64_t RcPwmModule::pulse_ticks(unsigned unit) const {
    return widths_[unit] == NO_PULSE ? 0 : (widths_[unit] + 1) * WIDTH_TICKS;
}

std::int64_t RcPwmModule::pulse_ns(unsigned unit) const {
    return time_of_tick(pulse_ticks(unit), clock_hz_);
}

std::int64_t RcPwmModule::period_ns() const {
    return time_of_tick(rate_ + RATE_OFFSET, clock_hz_);
}

bool RcPwmModule::output(unsigned unit, std::uint8_t function) const {
    return unit < widths_.size() && function == PULSE_PIN &&
           ticks_at(time_ns_, clock_hz_) % (rate_ + RATE_OFFSET) < pulse_ticks(unit);
}

}  // namespace mw::mesa::board

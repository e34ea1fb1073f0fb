// SPDX-License-Identifier: GPL-2.0-or-later
// spindle: ramps for a spindle drive with forward and reverse inputs, up to 16 gears (`numgears=`, 1 by
// default).
//
// The speed follows `commanded-speed` [rpm], its magnitude limited to the gear's `min` and `max`, with at
// most `accel` and `decel` [rpm/s]: with `simulate-encoder` (bit) the output is a ramp; otherwise `output`
// [rpm] leads `actual-speed` [turns/s] by at most the change of speed in one period. While `enable` (bit) is
// false the requested speed is 0. The manual page describes all pins. A command that is not a number counts
// as 0.
#include <cmath>

#include "components/limit/limit_core.hh"
#include "hal/sdk/component.hh"

constexpr int MAX_GEARS = 16;
static int numgears[mw::sdk::MANY];
RTAPI_MP_ARRAY_INT(numgears, mw::sdk::MANY, "gears of each instance");

namespace mw::components {
using namespace sdk;

struct Gear {
    In<double> scale, min, max, accel, decel, speed_tolerance, zero_tolerance, offset;
    In<bool> select;
};

struct Spindle {
    int gears = 1;
    Gear gear[MAX_GEARS];
    In<std::uint32_t> select_gear;
    In<double> commanded_speed, actual_speed, spindle_lpf;
    In<bool> simulate_encoder, enable;
    Out<double> spindle_rpm, spindle_rpm_abs, output;
    Out<std::uint32_t> current_gear;
    Out<bool> at_speed, forward, reverse, brake, zero_speed, limited;
    double ramp_rpm = 0.0;
    double smooth_rpm = 0.0;

    void declare(Declare &d) noexcept;
    void declare_gear(Declare &d, int number) noexcept;
    void update(long period_ns) noexcept;

  private:
    std::uint32_t chosen_gear() const noexcept;
    double target(const Gear &used) noexcept;
    void show(double rpm, double wanted, const Gear &used, double dt) noexcept;
};

void Spindle::declare(Declare &d) noexcept {
    gears = numgears[d.index()] == 0 ? 1 : numgears[d.index()];
    if (gears < 1 || gears > MAX_GEARS) {
        rtapi_print_msg(RTAPI_MSG_ERR, "spindle: numgears=%d, possible are 1 to %d", gears, MAX_GEARS);
        d.keep(-EINVAL);
        return;
    }
    d.pin(select_gear, "select-gear");
    d.pin(commanded_speed, "commanded-speed");
    d.pin(actual_speed, "actual-speed");
    d.pin(simulate_encoder, "simulate-encoder");
    d.pin(enable, "enable");
    d.pin(spindle_lpf, "spindle-lpf");
    d.pin(spindle_rpm, "spindle-rpm");
    d.pin(spindle_rpm_abs, "spindle-rpm-abs");
    d.pin(output, "output");
    d.pin(current_gear, "current-gear");
    d.pin(at_speed, "at-speed");
    d.pin(forward, "forward");
    d.pin(reverse, "reverse");
    d.pin(brake, "brake");
    d.pin(zero_speed, "zero-speed");
    d.pin(limited, "limited");
    for (int i = 0; i < gears; ++i) {
        declare_gear(d, i);
    }
    d.function<&Spindle::update>(this);
}

void Spindle::declare_gear(Declare &d, int number) noexcept {
    Gear &made = gear[number];
    d.pin_at(made.scale, "scale.%d", number, 1.0);
    d.pin_at(made.min, "min.%d", number);
    d.pin_at(made.max, "max.%d", number);
    d.pin_at(made.accel, "accel.%d", number);
    d.pin_at(made.decel, "decel.%d", number);
    d.pin_at(made.speed_tolerance, "speed-tolerance.%d", number, 20.0);
    d.pin_at(made.zero_tolerance, "zero-tolerance.%d", number, 20.0);
    d.pin_at(made.offset, "offset.%d", number);
    d.pin_at(made.select, "select.%d", number, gears == 1);
}

/// The highest gear selected by a bit, otherwise the number in select-gear.
std::uint32_t Spindle::chosen_gear() const noexcept {
    for (int i = gears - 1; i > 0; --i) {
        if (gear[i].select) {
            return static_cast<std::uint32_t>(i);
        }
    }
    const std::uint32_t wanted = select_gear;
    return wanted < static_cast<std::uint32_t>(gears) ? wanted : 0U;
}

/// The requested speed, within the limits of the gear [rpm].
double Spindle::target(const Gear &used) noexcept {
    const double command = commanded_speed;
    const double size = std::isfinite(command) ? std::fabs(command) : 0.0;
    if (!enable || size == 0.0) {
        limited = false;
        return 0.0;
    }
    const bool has_max = used.max != 0.0;
    const double held = limit::between(size, used.min, has_max ? used.max.get() : HUGE_VAL);
    limited = held != size;
    return std::copysign(held, command);
}

void Spindle::show(double rpm, double wanted, const Gear &used, double dt) noexcept {
    spindle_rpm = rpm;
    const double size = std::fabs(rpm);
    const bool is_at_speed = std::fabs(rpm - wanted) < used.speed_tolerance;
    const double filter = spindle_lpf * dt;
    const bool filtered = is_at_speed && filter > 0.0 && filter < 1.0 && std::isfinite(smooth_rpm);
    smooth_rpm = filtered ? smooth_rpm + (size - smooth_rpm) * filter : size;
    spindle_rpm_abs = smooth_rpm;
    at_speed = is_at_speed;
    zero_speed = size < used.zero_tolerance;
}

void Spindle::update(long period_ns) noexcept {
    const double dt = seconds(period_ns);
    const std::uint32_t number = chosen_gear();
    const Gear &used = gear[number];
    current_gear = number;
    const double wanted = target(used);
    const bool simulated = simulate_encoder;
    const double measured = actual_speed * 60.0;
    const double base = simulated || !std::isfinite(measured) ? ramp_rpm : measured;
    // Uses accel away from zero and decel towards zero; a change of direction takes two steps.
    const double unit = simulated ? dt : 1.0;
    const double up = std::fmax(0.0, used.accel) * unit;
    const double down = std::fmax(0.0, used.decel) * unit;
    const double sign = base < 0.0 || (base == 0.0 && wanted < 0.0) ? -1.0 : 1.0;
    const double size = std::fabs(base);
    const double goal = wanted * sign;
    const bool slowing = goal < size;
    const double next = slowing ? std::fmax(std::fmax(goal, 0.0), size - down) : std::fmin(goal, size + up);
    ramp_rpm = sign * next;
    brake = slowing;
    forward = ramp_rpm > 0.0;
    reverse = ramp_rpm < 0.0;
    set_finite(output, (std::fabs(ramp_rpm) + used.offset) * used.scale);
    const double asked = enable ? commanded_speed.get() : 0.0;
    show(simulated ? ramp_rpm : measured, asked, used, dt);
}

}  // namespace mw::components

MW_COMPONENT(mw::components::Spindle, "spindle", mw::sdk::MANY);

// SPDX-License-Identifier: GPL-2.0-or-later
#include "drivers/mesa/board/physics.hh"

#include <algorithm>
#include <cmath>

#include "drivers/mesa/board/clock.hh"

namespace mw::mesa::board {

namespace {

/// Time step in which a PWM motor is assumed to move uniformly.
constexpr std::int64_t SPAN_NS = 100'000;
/// Limits the work for a long time without requests.
constexpr std::int64_t MAX_SPANS = 10'000;

}  // namespace

Physics::Physics(PhysicsPlan plan) : plan_(std::move(plan)), motors_(plan_.motors.size()) {
    for (std::size_t i = 0; i < motors_.size(); ++i) {
        motors_[i].rev = plan_.motors[i].start_rev;
    }
    show_positions();
}

void Physics::show_positions() {
    if (plan_.panel != nullptr) {
        for (std::size_t i = 0; i < std::min(motors_.size(), HandPanelPage::MOTORS); ++i) {
            plan_.panel->page().position_rev[i] = position_rev(i);
        }
    }
}

double Physics::position_rev(std::size_t motor) const {
    const MotorPlan &plan = plan_.motors[motor];
    if (plan.type == MotorType::PWM) {
        return motors_[motor].rev;
    }
    return plan.start_rev +
           static_cast<double>(motors_[motor].steps) / static_cast<double>(plan.steps_per_rev);
}

std::int64_t Physics::count_of(const EncoderPlan &encoder) const {
    const MotorPlan &plan = plan_.motors[encoder.motor];
    const Motor &motor = motors_[encoder.motor];
    const auto counts_per_rev = static_cast<double>(encoder.counts_per_rev);
    if (plan.type == MotorType::PWM) {
        return static_cast<std::int64_t>(std::floor(motor.rev * counts_per_rev));
    }
    const auto start = static_cast<std::int64_t>(std::floor(plan.start_rev * counts_per_rev));
    return start + multiply_divide(motor.steps, encoder.counts_per_rev, plan.steps_per_rev);
}

void Physics::move_motors(double span_s, const DriveInputs &inputs, MotorType type) {
    for (std::size_t i = 0; i < motors_.size(); ++i) {
        const MotorPlan &plan = plan_.motors[i];
        if (plan.type != type) {
            continue;
        }
        Motor &motor = motors_[i];
        if (type == MotorType::STEPPER) {
            motor.steps += plan.unit < inputs.steps.size() ? inputs.steps[plan.unit] : 0;
            continue;
        }
        const double duty = plan.unit < inputs.duties.size() ? inputs.duties[plan.unit] : 0.0;
        const double target = duty * plan.full_rev_s;
        const double lag_s = plan.time_constant_s;
        const double rest = lag_s > 0 ? std::exp(-span_s / lag_s) : 0.0;
        motor.rev += target * span_s + (motor.rev_s - target) * lag_s * (1.0 - rest);
        motor.rev_s = target + (motor.rev_s - target) * rest;
    }
}

void Physics::step(std::int64_t from_ns, std::int64_t to_ns, const DriveInputs &inputs, const OnMove &on_move,
                   MotorType type) {
    std::vector<std::int64_t> before;
    for (const EncoderPlan &encoder : plan_.encoders) {
        before.push_back(count_of(encoder));
    }
    move_motors(static_cast<double>(to_ns - from_ns) / static_cast<double>(NS_IN_S), inputs, type);
    for (std::size_t i = 0; i < plan_.encoders.size(); ++i) {
        const EncoderPlan &encoder = plan_.encoders[i];
        const std::int64_t count = count_of(encoder);
        if (count != before[i]) {
            on_move(encoder.encoder,
                    {.from_count = before[i], .to_count = count, .from_ns = from_ns, .to_ns = to_ns});
        }
    }
}

void Physics::advance(std::int64_t from_ns, std::int64_t to_ns, const DriveInputs &inputs,
                      const OnMove &on_move) {
    if (to_ns <= from_ns) {
        return;
    }
    step(from_ns, to_ns, inputs, on_move, MotorType::STEPPER);
    const bool has_pwm =
        std::ranges::any_of(plan_.motors, [](const MotorPlan &one) { return one.type == MotorType::PWM; });
    if (!has_pwm) {
        show_positions();
        return;
    }
    const std::int64_t spans = std::clamp((to_ns - from_ns) / SPAN_NS, std::int64_t{1}, MAX_SPANS);
    for (std::int64_t i = 0; i < spans; ++i) {
        const auto time_of = [&](std::int64_t span) {
            return from_ns + multiply_divide(to_ns - from_ns, span, spans);
        };
        step(time_of(i), time_of(i + 1), inputs, on_move, MotorType::PWM);
    }
    show_positions();
}

std::optional<Shaft> Physics::shaft(unsigned encoder) const {
    const auto one = std::ranges::find(plan_.encoders, encoder, &EncoderPlan::encoder);
    if (one == plan_.encoders.end()) {
        return {};
    }
    const double index = one->index_rev * static_cast<double>(one->counts_per_rev);
    return Shaft{.count = count_of(*one),
                 .index_count = static_cast<std::int64_t>(std::floor(index)),
                 .counts_per_rev = one->counts_per_rev};
}

std::optional<double> Physics::resolver_rev(unsigned channel) const {
    const auto one = std::ranges::find(plan_.resolvers, channel, &ResolverPlan::channel);
    if (one == plan_.resolvers.end()) {
        return {};
    }
    return (position_rev(one->motor) - one->zero_rev) * static_cast<double>(one->cycles_per_rev);
}

bool Physics::level_of(const SwitchPlan &one) const {
    const double position = position_rev(one.motor);
    bool closed = one.above ? position > one.at_rev : position < one.at_rev;
    const auto number = static_cast<std::size_t>(&one - plan_.switches.data());
    if (plan_.panel != nullptr && number < HandPanelPage::SWITCHES) {
        const std::uint8_t hand = plan_.panel->page().contact[number];
        closed = hand == 0 ? closed : hand == 1;
    }
    return closed == one.closed_level;
}

std::optional<bool> Physics::switch_level(unsigned pin) const {
    std::optional<bool> level;
    for (const SwitchPlan &one : plan_.switches) {
        if (one.pin != pin || one.remote.has_value() || one.multiplexed) {
            continue;
        }
        // Several switches at a pin are parallel: each of them can close the circuit.
        const bool own = level_of(one);
        level = !level.has_value() || own == one.closed_level ? own : level;
    }
    return level;
}

std::uint32_t Physics::field_value(const FieldPlan &field) const {
    if (!field.motor.has_value()) {
        return field.value;
    }
    const double counts = position_rev(*field.motor) * static_cast<double>(field.counts_per_rev);
    return static_cast<std::uint32_t>(static_cast<std::int64_t>(std::floor(counts)));
}

std::uint32_t Physics::multiplexed_levels(std::uint32_t levels) const {
    for (const SwitchPlan &one : plan_.switches) {
        if (one.multiplexed) {
            levels = (levels & ~(1U << one.pin)) | (level_of(one) ? 1U << one.pin : 0U);
        }
    }
    return levels;
}

}  // namespace mw::mesa::board

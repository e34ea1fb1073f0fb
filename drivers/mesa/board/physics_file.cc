// SPDX-License-Identifier: GPL-2.0-or-later
#include <algorithm>
#include <optional>

#include <fmt/format.h>

#include "base/text.hh"
#include "drivers/mesa/board/modules/resolver.hh"
#include "drivers/mesa/board/modules/smart_serial.hh"
#include "drivers/mesa/board/physics.hh"
#include "drivers/mesa/board/table_file.hh"

namespace mw::mesa::board {

namespace {

constexpr double FAR_REV = 1e9;

/// Number of instances of modules of these types in a firmware.
unsigned instances_of(const Idrom &idrom, std::initializer_list<Gtag> gtags) {
    unsigned count = 0;
    for (const ModuleDescriptor &module : idrom.modules) {
        count += std::ranges::find(gtags, module.gtag) != gtags.end() ? module.instances : 0U;
    }
    return count;
}

/// A unit from 0 to below `count`.
unsigned unit_of(TableLine &line, std::string_view key, unsigned count) {
    if (count == 0) {
        line.reject(key, fmt::format("The board has no module '{}'.", key));
        return 0;
    }
    return static_cast<unsigned>(line.whole(key, 0, count - 1));
}

/// The number that follows the type of the line, from 0 to below `count`.
unsigned number_of(TableLine &line, std::string_view what, std::size_t count) {
    const auto number = parse_int(line.name());
    if (!number.has_value() || *number < 0 || *number >= static_cast<std::int64_t>(count)) {
        line.reject("", fmt::format("The board has no {1} '{0}': it has {2}.", line.name(), what, count));
        return 0;
    }
    return static_cast<unsigned>(*number);
}

std::size_t motor_of(TableLine &line, const PhysicsPlan &plan) {
    std::vector<std::string> names;
    for (const MotorPlan &motor : plan.motors) {
        names.push_back(motor.name);
    }
    return line.choice("motor", names);
}

void read_motor(TableLine &line, PhysicsPlan &plan, const Idrom &idrom) {
    MotorPlan motor{.name = line.name()};
    const bool named = !motor.name.empty();
    if (!named || std::ranges::find(plan.motors, motor.name, &MotorPlan::name) != plan.motors.end()) {
        line.reject("", named ? fmt::format("Motor '{}' is declared twice.", motor.name)
                              : "A motor needs a name.");
    }
    motor.type = line.has("pwm") ? MotorType::PWM : MotorType::STEPPER;
    if (motor.type == MotorType::PWM) {
        motor.unit = unit_of(line, "pwm", instances_of(idrom, {Gtag::PWM}));
        motor.full_rev_s = line.number("full_rev_s", -FAR_REV, FAR_REV);
        motor.time_constant_s = line.number("time_constant_s", 0, 1000, 0.0);
    } else {
        motor.unit = unit_of(line, "stepgen", instances_of(idrom, {Gtag::STEPGEN}));
        motor.steps_per_rev = line.whole("steps_per_rev", 1, 1'000'000'000);
    }
    motor.start_rev = line.number("start_rev", -FAR_REV, FAR_REV, 0.0);
    plan.motors.push_back(motor);
}

void read_encoder(TableLine &line, PhysicsPlan &plan, const Idrom &idrom) {
    EncoderPlan encoder;
    encoder.encoder = number_of(line, "encoder", instances_of(idrom, {Gtag::ENCODER, Gtag::MUXED_ENCODER}));
    encoder.motor = motor_of(line, plan);
    encoder.counts_per_rev = line.whole("counts_per_rev", 4, 100'000'000);
    encoder.index_rev = line.number("index_rev", 0, 0.999999, 0.0);
    plan.encoders.push_back(encoder);
}

unsigned port_of(TableLine &line, const Idrom &idrom) {
    return line.has("port") ? unit_of(line, "port", instances_of(idrom, {Gtag::SMART_SERIAL})) : 0U;
}

void read_switch(TableLine &line, PhysicsPlan &plan, const Idrom &idrom) {
    SwitchPlan one;
    if (line.has("remote")) {
        constexpr std::size_t INPUT_BITS = 32;
        one.remote = {port_of(line, idrom), unit_of(line, "remote", SERIAL_CHANNELS)};
        one.pin = number_of(line, "input", INPUT_BITS);
    } else if (line.has("inmux")) {
        constexpr std::size_t INPUTS = 32;
        one.multiplexed = true;
        unit_of(line, "inmux", std::min(instances_of(idrom, {Gtag::IN_MUX}), 1U));  // one is simulated
        one.pin = number_of(line, "input", INPUTS);
    } else {
        one.pin = number_of(line, "pin", idrom.pins.size());
    }
    one.motor = motor_of(line, plan);
    one.above = line.has("above_rev");
    one.at_rev = line.number(one.above ? "above_rev" : "below_rev", -FAR_REV, FAR_REV);
    one.closed_level = line.choice("closed", {"low", "high"}, 1) == 1;
    plan.switches.push_back(one);
}

void read_resolver(TableLine &line, PhysicsPlan &plan, const Idrom &idrom) {
    ResolverPlan resolver;
    resolver.channel = number_of(line, "resolver", instances_of(idrom, {Gtag::RESOLVER}) * RESOLVER_CHANNELS);
    resolver.motor = motor_of(line, plan);
    resolver.cycles_per_rev = line.whole("cycles_per_rev", 1, 1000, 1);
    resolver.zero_rev = line.number("zero_rev", -FAR_REV, FAR_REV, 0.0);
    plan.resolvers.push_back(resolver);
}

void read_field(TableLine &line, PhysicsPlan &plan, const Idrom &idrom) {
    FieldPlan field;
    field.remote = {port_of(line, idrom), number_of(line, "smart serial channel", SERIAL_CHANNELS)};
    field.name = line.text("name");
    if (line.has("motor")) {
        field.motor = motor_of(line, plan);
        field.counts_per_rev = line.whole("counts_per_rev", 1, 100'000'000);
    } else {
        field.value = static_cast<std::uint32_t>(line.whole("value", 0, UINT32_MAX));
    }
    plan.fields.push_back(field);
}

void read_remote(TableLine &line, PhysicsPlan &plan, const Idrom &idrom) {
    RemotePlan remote;
    remote.channel = number_of(line, "smart serial channel", SERIAL_CHANNELS);
    remote.port = port_of(line, idrom);
    remote.card = line.text("card");
    if (find_remote_card(remote.card) == nullptr) {
        line.reject("card", fmt::format("Unknown card '{}', known are {}.", remote.card,
                                        fmt::join(remote_card_names(), ", ")));
    }
    // Each part of a card with several channels is a separate remote.
    for (const RemoteCard *card = find_remote_card(remote.card); card != nullptr;
         card = find_remote_card(card->next_channel)) {
        if (remote.channel >= SERIAL_CHANNELS) {
            line.reject("card", fmt::format("Card '{}' needs more channels than the port has.", remote.card));
            break;
        }
        remote.card = card->key;
        plan.remotes.push_back(remote);
        remote.channel += 1;
    }
}

}  // namespace

Result<PhysicsPlan> parse_physics(std::string_view text, const std::string &file, const Idrom &idrom) {
    auto lines = parse_table(text, file);
    if (!lines.has_value()) {
        return std::unexpected(lines.error());
    }
    PhysicsPlan plan;
    for (TableLine &line : *lines) {
        if (line.type() == "motor") {
            read_motor(line, plan, idrom);
        } else if (line.type() == "encoder") {
            read_encoder(line, plan, idrom);
        } else if (line.type() == "switch") {
            read_switch(line, plan, idrom);
        } else if (line.type() == "resolver") {
            read_resolver(line, plan, idrom);
        } else if (line.type() == "field") {
            read_field(line, plan, idrom);
        } else if (line.type() == "panel") {
            auto panel = HandPanel::open(line.name());
            if (!panel.has_value()) {
                return fail(panel.error().message, line.place());
            }
            plan.panel = std::move(*panel);
        } else if (line.type() == "remote") {
            read_remote(line, plan, idrom);
        } else {
            return fail(
                fmt::format(
                    "Unknown line '{}', expected motor, encoder, switch, resolver, field, panel or remote.",
                    line.type()),
                line.place());
        }
        if (auto finished = line.finish(); !finished.has_value()) {
            return std::unexpected(finished.error());
        }
    }
    return plan;
}

}  // namespace mw::mesa::board

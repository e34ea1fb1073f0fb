// SPDX-License-Identifier: GPL-2.0-or-later
#include "commissioning/world.hh"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include <fmt/format.h>

#include "base/atomic_file.hh"

namespace mw::commissioning_campaign {
namespace {

constexpr int PORT_HOMES[] = {11, 12, 13}, PORT_ESTOP = 10, PORT_PROBE = 15;
constexpr int MESA_PROBE = 9;

char small(char letter) {
    return static_cast<char>(letter + 'a' - 'A');
}

}  // namespace

World::World(const TrueMachine &machine, std::string folder)
    : machine_(machine), folder_(std::move(folder)), pressed_(machine.axes.size()),
      random_(machine.seed + 7) {
    for (const TrueAxis &axis : machine_.axes) {
        tables_.push_back(axis.start);
        motors_.push_back(axis.start);
    }
}

std::size_t World::find_axis(char letter) const {
    return static_cast<std::size_t>(std::ranges::find(machine_.axes, letter, &TrueAxis::letter) -
                                    machine_.axes.begin());
}

std::size_t World::switch_place(std::size_t axis) const {
    const bool exchanged = machine_.trouble == Trouble::SWITCHES_EXCHANGED && axis < 2;
    return exchanged ? 1 - axis : axis;
}

/// Steppers at the pins of the port.
std::string World::port_text() const {
    std::string names, text;
    for (std::size_t i = 0; i < machine_.axes.size(); ++i) {
        const TrueAxis &axis = machine_.axes[i];
        const std::string name = fmt::format("table-{}", small(axis.letter));
        names += (i == 0 ? "" : ",") + name;
        const bool connected = machine_.trouble != Trouble::MOTOR_NOT_CONNECTED || machine_.trouble_axis != i;
        const bool wired = machine_.trouble != Trouble::SWITCH_NOT_CONNECTED || machine_.trouble_axis != i;
        text += fmt::format(
            "addf {0} base-thread\n"
            "setp {0}.units-per-step {1:.12g}\nsetp {0}.backlash {2:.9g}\n"
            "setp {0}.peak-acceleration {3:.9g}\nsetp {0}.fastest {4:.9g}\n"
            "setp {0}.lower-end {5:.9g}\nsetp {0}.upper-end {6:.9g}\nsetp {0}.start {7:.12g}\n"
            "setp {0}.switch-at {8:.9g}\nsetp {0}.switch-below {9}\nsetp {0}.switch-inverted {10}\n",
            name, axis.travel_per_rev / axis.steps_per_rev, axis.backlash, axis.peak_acceleration,
            axis.fastest, axis.lower_end, axis.upper_end, motors_[i], axis.switch_at,
            axis.switch_above ? 0 : 1, axis.isContactOpening ? 1 : 0);
        const int step_pin = 2 + 2 * static_cast<int>(i);
        if (connected) {
            text += fmt::format("net wire-{0}-step parport.0.pin-{1:02d}-out-fake => {2}.step\n"
                                "net wire-{0}-dir parport.0.pin-{3:02d}-out-fake => {2}.dir\n",
                                small(axis.letter), step_pin, name, step_pin + 1);
        }
        if (wired) {
            text += fmt::format("net wire-{0}-switch {1}.switch => parport.0.pin-{2}-in-fake\n",
                                small(axis.letter), name, PORT_HOMES[switch_place(i)]);
        }
    }
    return "loadrt plant_stepper names=" + names + "\n" + text;
}

/// Motors at the simulated board.
std::string World::physics_text() const {
    std::string text, encoders, switches;
    const bool servo = machine_.board == Board::MESA_SERVO;
    const char *const where = servo ? "inmux=0" : "remote=0";
    for (std::size_t i = 0; i < machine_.axes.size(); ++i) {
        const TrueAxis &axis = machine_.axes[i];
        const char name = small(axis.letter);
        const bool connected = machine_.trouble != Trouble::MOTOR_NOT_CONNECTED || machine_.trouble_axis != i;
        const bool wired = machine_.trouble != Trouble::SWITCH_NOT_CONNECTED || machine_.trouble_axis != i;
        // The last channels of the boards have no motor.
        const std::size_t channel = connected ? i : 4;
        const double turn = axis.travel_per_rev;
        const double start_rev = motors_[i] / turn;
        if (servo) {
            text +=
                fmt::format("motor {} pwm={} full_rev_s={:.9g} time_constant_s={:.9g} start_rev={:.12g}\n",
                            name, channel, axis.full_rev_s, axis.lag_s, start_rev);
            const bool lost =
                machine_.trouble == Trouble::ENCODER_NOT_CONNECTED && machine_.trouble_axis == i;
            encoders += fmt::format("encoder {} motor={} counts_per_rev={:.0f}\n", lost ? 5 : i, name,
                                    axis.counts_per_rev);
        } else {
            text += fmt::format("motor {} stepgen={} steps_per_rev={:.0f} start_rev={:.12g}\n", name, channel,
                                axis.steps_per_rev, start_rev);
        }
        const bool above = axis.switch_above == (turn > 0);
        switches += fmt::format("switch {} {} motor={} {}_rev={:.12g}{}\n", wired ? switch_place(i) : 12 + i,
                                where, name, above ? "above" : "below", axis.switch_at / turn,
                                axis.isContactOpening ? " closed=low" : "");
    }
    const char name = small(machine_.axes[0].letter);
    switches += fmt::format("switch {} {} motor={} above_rev=-1000000{}\n", servo ? 15 : 31, where, name,
                            machine_.trouble == Trouble::ESTOP_NORMALLY_OPEN ? " closed=low" : "");
    switches += fmt::format("switch {} {} motor={} below_rev=-1000000{}\n", MESA_PROBE, where, name,
                            machine_.isProbeOpening ? " closed=low" : "");
    return text + encoders + (servo ? "" : "remote 0 card=7i76\n") + switches + "panel " + folder_ +
           "/panel\n";
}

Result<std::string> World::prepare(const std::string &ini) {
    controller_ = nullptr;
    if (!isPort()) {
        const std::string physics = folder_ + "/truth.txt";
        ::setenv("MILLWRIGHT_MESA",
                 fmt::format("192.168.1.121={}:{}", machine_.board == Board::MESA_SERVO ? "7i97" : "7i76e",
                             physics)
                     .c_str(),
                 1);
        auto written = write_file_atomically(physics, physics_text());
        auto panel = mesa::board::HandPanel::open(folder_ + "/panel");
        if (!written.has_value() || !panel.has_value()) {
            return fail("no world");
        }
        panel_ = std::move(*panel);
        return ini;
    }
    auto text = read_file(ini);
    if (!text.has_value()) {
        return text;
    }
    const std::string mark = "HALFILE = threads.hal\n";
    const std::size_t at = text->find(mark);
    text->insert(at + mark.size(), "HALFILE = truth.hal\n");
    const std::string mine = ini.substr(0, ini.rfind('/')) + "/with_truth.ini";
    auto written = write_file_atomically(ini.substr(0, ini.rfind('/')) + "/truth.hal", port_text());
    written = written.has_value() ? write_file_atomically(mine, *text) : written;
    return written.has_value() ? Result<std::string>(mine) : std::unexpected(written.error());
}

void World::set(const std::string &pin, double value) {
    const auto current = controller_->hal().values().get(pin);
    if (current.has_value()) {
        const bool bit = current->type == hal::Type::BIT;
        static_cast<void>(controller_->hal().values().set(pin, bit ? hal::Value::of_bit(value != 0)
                                                                   : hal::Value::of_float(value)));
    }
}

double World::get(const std::string &pin) const {
    const auto value = controller_->hal().values().get(pin);
    return value.has_value() ? value->as_number() : 0;
}

double World::motor_position(std::size_t axis) const {
    const TrueAxis &one = machine_.axes[axis];
    if (isPort()) {
        return get(fmt::format("table-{}.table", small(one.letter)));
    }
    return panel_->page().position_rev[axis] * one.travel_per_rev;
}

void World::make_noise() {
    if (machine_.trouble == Trouble::NOISE && random_() % 50 == 0) {
        press_switch(machine_.trouble_axis, random_() % 2 == 0);
    }
}

void World::show_hands() {
    for (std::size_t i = 0; i < machine_.axes.size(); ++i) {
        if (isPort()) {
            set(fmt::format("table-{}.press", small(machine_.axes[i].letter)), pressed_[i] ? 1 : 0);
        } else {
            panel_->page().contact[i] = pressed_[i] ? 1 : 0;
        }
    }
    const bool normally_open = machine_.trouble == Trouble::ESTOP_NORMALLY_OPEN;
    if (isPort()) {
        set(fmt::format("parport.0.pin-{}-in-fake", PORT_ESTOP), isEstopPressed_ == normally_open ? 1 : 0);
        set(fmt::format("parport.0.pin-{}-in-fake", PORT_PROBE),
            isProbeTouched_ != machine_.isProbeOpening ? 1 : 0);
    } else {
        const std::size_t estop = machine_.axes.size();
        panel_->page().contact[estop] = isEstopPressed_ ? 2 : 0;
        panel_->page().contact[estop + 1] = isProbeTouched_ ? 1 : 0;
    }
}

void World::step() {
    make_noise();
    show_hands();
    for (std::size_t i = 0; i < machine_.axes.size(); ++i) {
        const TrueAxis &axis = machine_.axes[i];
        motors_[i] = motor_position(i);
        const double play = isPort() ? 0 : axis.backlash / 2;
        tables_[i] = std::clamp(tables_[i], motors_[i] - play, motors_[i] + play);
        const bool hit = isPort() && get(fmt::format("table-{}.hit", small(axis.letter))) != 0;
        const bool beyond = tables_[i] < axis.lower_end || tables_[i] > axis.upper_end;
        if ((hit || beyond) && damage_.empty()) {
            damage_ = fmt::format("end stop: {} at {:.2f} of {:.2f} to {:.2f}", axis.letter, tables_[i],
                                  axis.lower_end, axis.upper_end);
        }
    }
}

int World::count_enabled() const {
    int count = 0;
    for (std::size_t i = 0; i < machine_.axes.size(); ++i) {
        const std::string pin = isPort() ? fmt::format("stepgen.{}.enable", i)
                                : machine_.board == Board::MESA_STEPPER
                                    ? fmt::format("hm2_7i76e.0.stepgen.{:02d}.enable", i)
                                    : fmt::format("hm2_7i97.0.pwmgen.{:02d}.enable", i);
        count += get(pin) != 0 ? 1 : 0;
    }
    return count;
}

bool World::hasSlipped() const {
    for (const TrueAxis &axis : machine_.axes) {
        if (isPort() && get(fmt::format("table-{}.slipped", small(axis.letter))) != 0) {
            return true;
        }
    }
    return false;
}

double World::spindle_rpm() const {
    double part = 0;
    if (isPort()) {
        part = get("pwmgen.0.enable") != 0 ? get("pwmgen.0.value") / get("pwmgen.0.scale") : 0;
    } else if (machine_.board == Board::MESA_STEPPER) {
        part = get("hm2_7i76e.0.7i76.0.0.spinena") != 0
                   ? get("hm2_7i76e.0.7i76.0.0.spinout") / get("hm2_7i76e.0.7i76.0.0.spinout-scalemax")
                   : 0;
    } else {
        part = get("hm2_7i97.0.pwmgen.05.enable") != 0
                   ? get("hm2_7i97.0.pwmgen.05.value") / get("hm2_7i97.0.pwmgen.05.scale")
                   : 0;
    }
    return std::clamp(part, 0.0, 1.0) * machine_.spindle_full_rpm;
}

void World::press_switch(std::size_t axis, bool isPressed) {
    pressed_[axis] = isPressed;
}

void World::press_estop(bool isPressed) {
    isEstopPressed_ = isPressed && machine_.trouble != Trouble::ESTOP_NOT_CONNECTED;
}

void World::touch_probe(bool isTouched) {
    isProbeTouched_ = isTouched && machine_.trouble != Trouble::PROBE_NOT_CONNECTED;
}

}  // namespace mw::commissioning_campaign

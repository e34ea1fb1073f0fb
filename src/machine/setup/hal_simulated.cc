// SPDX-License-Identifier: GPL-2.0-or-later
// The HAL files of machines without hardware, and the devices connected to simulated boards.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/text.hh"
#include "machine/setup/detail/hal_parts.hh"

namespace mw::setup::detail {

namespace {

double switch_position(const Plan &plan, const Axis &axis) {
    return plan.small(axis, axis.home_at_max ? 20 : -20);
}

}  // namespace

std::string simulated_motors_hal(const Plan &plan) {
    std::string text = heading("Simulated motors: each is at its commanded position.");
    each_motor(plan, [&](const Axis &, const Motor &motor, int joint) {
        text +=
            fmt::format("net {0}-pos joint.{1}.motor-pos-cmd => joint.{1}.motor-pos-fb\n", motor.name, joint);
    });
    return text;
}

std::string simulated_switches_hal(const Plan &plan) {
    if (plan.switches == Switches::NONE) {
        return {};
    }
    std::string names, wires;
    each_motor(plan, [&](const Axis &axis, const Motor &motor, int joint) {
        names += (names.empty() ? "" : ",") + ("switch-" + motor.name);
        wires += fmt::format("\nsetp switch-{0}.home-pos {1}\n"
                             "setp switch-{0}.hysteresis {2}\n"
                             "net {0}-pos => switch-{0}.cur-pos\n"
                             "net {0}-switch switch-{0}.home-sw => joint.{3}.home-sw-in\n",
                             motor.name, to_text(switch_position(plan, axis)), to_text(plan.small(axis, 0.1)),
                             joint);
        if (plan.switches == Switches::HOME_AND_LIMITS) {
            wires += fmt::format("net {0}-switch => joint.{1}.{2}-lim-sw-in\n", motor.name, joint,
                                 axis.home_at_max ? "pos" : "neg");
        }
    });
    return heading("Simulated switches, a little past the start position of each motor.") +
           "loadrt sim_home_switch names=" + names + "\n" + wires;
}

std::string simulated_spindle_hal(const Plan &plan) {
    if (!hasSimulatedEncoder(plan)) {
        return {};
    }
    return heading("A simulated spindle with a ramp to its speed, and an encoder for threads.") +
           "loadrt limit2 names=spindle-ramp\n"
           "loadrt near names=spindle-near\n"
           "loadrt scale names=spindle-rps\n"
           "loadrt sim_spindle names=sim-spindle\n"
           "# [rev/min per second]\n"
           "setp spindle-ramp.maxv 5000\n"
           "setp spindle-near.scale 1.02\n"
           "setp spindle-near.difference 5\n"
           "setp spindle-rps.gain 0.0166666666666666667\n"
           "setp sim-spindle.scale 0.0166666666666666667\n"
           "net spindle-wanted spindle.0.speed-out => spindle-ramp.in spindle-near.in1\n"
           "net spindle-speed spindle-ramp.out => sim-spindle.velocity-cmd spindle-near.in2 spindle-rps.in\n"
           "net spindle-speed-rps spindle-rps.out => spindle.0.speed-in\n"
           "net spindle-angle sim-spindle.position-fb => spindle.0.revs\n"
           "net spindle-index sim-spindle.index-enable <=> spindle.0.index-enable\n"
           "net spindle-at-speed spindle-near.out => spindle.0.at-speed\n";
}

std::string simulated_wires_hal(const Plan &plan) {
    std::string text =
        heading("Simulates the inputs of a real machine: a button that is not pressed, and switches.");
    if (plan.wiring.estop_pin.has_value()) {
        text += fmt::format("setp {}-fake 1\n", in_pin(plan, *plan.wiring.estop_pin));
    }
    if (plan.switches == Switches::NONE) {
        return text;
    }
    std::string names, contacts, functions, wires;
    each_motor(plan, [&](const Axis &axis, const Motor &motor, int) {
        if (!motor.home_pin.has_value()) {
            return;
        }
        const std::string pin = in_pin(plan, *motor.home_pin);
        names += (names.empty() ? "" : ",") + ("switch-" + motor.name);
        functions += fmt::format("addf switch-{} servo-thread\n", motor.name);
        wires +=
            fmt::format("\nsetp switch-{0}.home-pos {1}\n"
                        "setp switch-{0}.hysteresis {2}\n"
                        "net {0}-pos-fb => switch-{0}.cur-pos\n",
                        motor.name, to_text(switch_position(plan, axis)), to_text(plan.small(axis, 0.1)));
        if (motor.home_contact_closed) {
            contacts += (contacts.empty() ? "" : ",") + ("contact-" + motor.name);
            functions += fmt::format("addf contact-{} servo-thread\n", motor.name);
            wires += fmt::format("net {0}-touched switch-{0}.home-sw => contact-{0}.in\n"
                                 "net {0}-contact contact-{0}.out => {1}-fake\n",
                                 motor.name, pin);
        } else {
            wires += fmt::format("net {0}-contact switch-{0}.home-sw => {1}-fake\n", motor.name, pin);
        }
    });
    return text + fmt::format("loadrt sim_home_switch names={}\n", names) +
           (contacts.empty() ? "" : fmt::format("loadrt not names={}\n", contacts)) + functions + wires;
}

std::string simulated_board_hal(const Plan &plan) {
    return heading("A simulated board at BOARD_IP of the INI file. Not for a real board.") +
           fmt::format("loadusr hm2-board --listen [HOSTMOT2]BOARD_IP --model {} --physics {}\n",
                       plan.board == Board::MESA_7I97 ? "7i97" : "7i76e", MOTORS_FILE);
}

std::string simulated_motors_text(const Plan &plan) {
    const bool servo = plan.is_servo;
    std::string text = "# Devices at the simulated board: motors, encoders and switches.\n";
    std::string encoders, switches;
    const char *const where = servo ? "inmux=0" : "remote=0";
    each_motor(plan, [&](const Axis &axis, const Motor &motor, int) {
        const double turn = std::abs(motor.travel_per_turn);
        if (servo) {
            text += fmt::format("motor {} pwm={} full_rev_s={} time_constant_s=0.02\n", motor.name,
                                motor.channel, to_text(std::abs(motor.servo.full_speed) / turn));
            encoders += fmt::format("encoder {} motor={} counts_per_rev={:.0f}\n", motor.channel, motor.name,
                                    std::abs(motor.servo.counts_per_unit) * turn);
        } else {
            text += fmt::format("motor {} stepgen={} steps_per_rev={:.0f}\n", motor.name, motor.channel,
                                std::abs(motor.steps_per_unit) * turn);
        }
        if (motor.home_pin.has_value()) {
            // A reversed motor moves to the switch in the opposite direction.
            const double scale = servo ? motor.servo.counts_per_unit : motor.steps_per_unit;
            const double at = switch_position(plan, axis) / turn * (scale < 0 ? -1 : 1);
            switches += fmt::format("switch {} {} motor={} {}={}{}\n", *motor.home_pin, where, motor.name,
                                    at > 0 ? "above_rev" : "below_rev", to_text(at),
                                    motor.home_contact_closed ? " closed=low" : "");
        }
    });
    text += encoders;
    text += servo ? "" : "remote 0 card=7i76\n";
    text += switches;
    if (plan.wiring.estop_pin.has_value()) {
        text += fmt::format("# The emergency stop button is released: its contact is closed.\n"
                            "switch {} {} motor={} above_rev=-1000000\n",
                            *plan.wiring.estop_pin, where, plan.axes[0].motors[0].name);
    }
    return text;
}

}  // namespace mw::setup::detail

// SPDX-License-Identifier: GPL-2.0-or-later
// The questions about motors and about the terminals of the board.
#include <algorithm>
#include <array>

#include "base/text.hh"
#include "machine/setup/detail/asking.hh"

namespace mw::setup::detail {
namespace {

/// Pins of a parallel port in the order in which they are proposed.
constexpr std::array PORT_OUTPUTS{2, 3, 4, 5, 6, 7, 8, 9, 1, 14, 16, 17};
constexpr std::array PORT_INPUTS{11, 12, 13, 15};
constexpr int FIELD_INPUTS = 32, FIELD_OUTPUTS = 16, SERVO_INPUTS = 16, SERVO_OUTPUTS = 6;
constexpr int MOST_NS = 1000000;

bool isRotary(const std::string &motor) {
    return motor[0] >= 'a' && motor[0] <= 'c';
}

}  // namespace

int Asking::most_terminals(bool isInput) const {
    if (isPort()) {
        return isInput ? 15 : 17;
    }
    const bool servo = isChosen("board", "7i97");
    return (isInput ? (servo ? SERVO_INPUTS : FIELD_INPUTS) : (servo ? SERVO_OUTPUTS : FIELD_OUTPUTS)) - 1;
}

int Asking::next_output() {
    const auto place = static_cast<std::size_t>(outputs_used_++);
    if (isPort()) {
        return place < PORT_OUTPUTS.size() ? PORT_OUTPUTS.at(place) : 0;
    }
    return static_cast<int>(place) <= most_terminals(false) ? static_cast<int>(place) : -1;
}

int Asking::next_input() {
    const auto place = static_cast<std::size_t>(inputs_used_++);
    if (isPort()) {
        return place < PORT_INPUTS.size() ? PORT_INPUTS.at(place) : 0;
    }
    return static_cast<int>(place) <= most_terminals(true) ? static_cast<int>(place) : -1;
}

void Asking::timing() {
    if (!isChosen("drives", "stepper")) {
        return;
    }
    const char *const why = "Long enough for nearly all drives; the manual of the drive has shorter ones.";
    const auto time = [&](const char *key, const char *text, int preset, int least) {
        whole(key, text, preset, "ns", why);
        within(least, MOST_NS);
    };
    time("step.length", "Step pulse width", 5000, 100);
    time("step.space", "Step pulse spacing", 5000, 100);
    time("step.dir_setup", "Direction setup time", 20000, 0);
    time("step.dir_hold", "Direction hold time", 20000, 0);
    if (isPort()) {
        whole("latency", "Latency of this computer (latency-test)", 15000, "ns",
              "A good computer; measure yours.");
        within(1000, MOST_NS);
    }
}

void Asking::motors() {
    for (const std::string &name : motors_of(kind_.name)) {
        motor(name);
    }
}

void Asking::motor(const std::string &name) {
    const std::string motor = "Motor " + to_upper(name) + ": ";
    if (isChosen("drives", "servo")) {
        servo(name);
    } else {
        number(name + ".steps_per_turn", motor + "full steps per revolution", 200, "",
               "Nearly all stepper motors turn 1.8 degrees in a step.");
        within(1, LONGEST);
        number(
            name + ".microsteps", motor + "microsteps per full step", 4, "",
            "Smooth enough, and slow enough for a parallel port. It must match the switches of the drive.");
        within(1, 1024);
    }
    transmission(name);
    connections(name);
}

void Asking::transmission(const std::string &name) {
    const std::string motor = "Motor " + to_upper(name) + ": ";
    const std::string key = name + ".transmission";
    choice(key, motor + "transmission",
           isRotary(name) ? std::vector<std::string>{"gear", "travel"}
                          : std::vector<std::string>{"travel", "screw", "belt", "rack"},
           "Travel: you know the travel of a motor revolution. Otherwise it is calculated.");
    const char *const linear = unit();
    if (isChosen(key, "travel")) {
        number(name + ".way_per_turn", motor + "travel per revolution (negative reverses)",
               isRotary(name) ? 4 : length(kind_.travel_per_turn), isRotary(name) ? "deg" : linear,
               "A usual screw or belt of such a machine.");
        within(-LONGEST, LONGEST);
    } else if (isChosen(key, "screw")) {
        number(name + ".pitch", motor + "travel per revolution of the screw", length(5), linear,
               "The most common ball screw.");
    } else if (isChosen(key, "belt")) {
        whole(name + ".teeth", motor + "teeth of the pulley", 20, "", "A usual pulley.");
        within(1, 1000);
        number(name + ".belt_pitch", motor + "pitch of the belt", metric_ ? 2 : 0.2, linear,
               metric_ ? "GT2 belts." : "XL belts.");
    } else if (isChosen(key, "rack")) {
        whole(name + ".teeth", motor + "teeth of the pinion", 20, "", "A usual pinion.");
        within(1, 1000);
        number(name + ".module", motor + "module of the rack", metric_ ? 1 : 0.04, linear, "A usual rack.");
    }
    if (!isChosen(key, "travel")) {
        number(name + ".gear", motor + "motor revolutions per revolution of its output",
               isRotary(name) ? 90 : 1, "", isRotary(name) ? "A usual worm gear." : "No gear.");
        choice(name + ".reverse", motor + "reverse the direction", {"no", "yes"},
               "`millwright commission check` finds it.");
    }
    number(name + ".correction", motor + "factor on the calculated scale", 1, "",
           "1: no correction. `millwright commission check` finds it with a ruler.");
    within(0.01, 100);
    number(name + ".backlash", motor + "backlash", 0, isRotary(name) ? "deg" : linear,
           "0: none compensated. `millwright commission check` finds it with an indicator.");
    within(0, 100);
}

void Asking::servo(const std::string &name) {
    const std::string motor = "Motor " + to_upper(name) + ": ";
    number(name + ".counts_per_turn", motor + "encoder counts per revolution", 4000, "",
           "An encoder of 1000 lines, four counts each.");
    within(1, 1e9);
    number(name + ".full_speed", motor + "revolutions per second at 10 V", 50, "rev/s",
           "3000 rev/min, a usual setting of drives.");
    choice(name + ".reverse_encoder", motor + "reverse the encoder", {"no", "yes"},
           "`millwright commission check` finds it.");
    choice(name + ".reverse_output", motor + "reverse the speed command", {"no", "yes"},
           "`millwright commission check` finds it.");
    number(
        name + ".p", motor + "proportional gain", 20, "1/s",
        "Low: it follows slowly, and does not oscillate. `millwright commission tune` finds a better one.");
    within(0, LONGEST);
    number(name + ".i", motor + "integral gain", 0, "1/s2", "None until the proportional gain is tuned.");
    within(0, 1e6);
    number(name + ".d", motor + "derivative gain", 0, "", "Drives with a speed loop need none.");
    within(0, LONGEST);
    number(name + ".ff1", motor + "velocity feed-forward", 1, "",
           "1: the drive turns at the commanded speed when its speed at 10 V is right.");
    within(0, 10);
    number(name + ".ff2", motor + "acceleration feed-forward", 0, "s", "0 until the drive is tuned.");
    within(0, 1);
}

void Asking::connections(const std::string &name) {
    const std::string motor = "Motor " + to_upper(name) + ": ";
    if (isPort()) {
        const char *const why = "The next free pin of the port.";
        whole(name + ".step_pin", motor + "step pin", next_output(), "", why);
        within(1, 17);
        whole(name + ".dir_pin", motor + "direction pin", next_output(), "", why);
        within(1, 17);
    } else {
        const auto names = motors_of(kind_.name);
        const auto place = std::ranges::find(names, name) - names.begin();
        whole(name + ".channel", motor + "connector of the board", static_cast<int>(place), "",
              "In the order of the joints.");
        within(0, isChosen("board", "7i97") ? 5 : 4);
    }
    if (!isChosen("switches", "none")) {
        whole(name + ".home_pin", motor + "home switch pin", next_input(), "", "The next free input.");
        within(isPort() ? 10 : 0, most_terminals(true));
        choice(name + ".home_contact", motor + "home switch contact", {"as_all", "open", "closed"},
               "As the answer switch.contacts, unless this switch differs.");
    }
}

void Asking::terminals() {
    const bool port = isPort(), is_foam = isFoam();
    const int most_out = most_terminals(false);
    const std::string zero = port ? ", 0: none" : ", -1: none";
    const auto output = [&](const char *key, const std::string &text, int preset, const char *why) {
        whole(key, text + zero, preset, "", why);
        within(none(), most_out);
    };
    output("pin.enable", "Drive enable pin", port ? 17 : -1,
           port ? "The last pin of the port."
                : "Most drives at this board need none, or use its own enable.");
    if (!isPlasma()) {
        spindle_terminals();
        output("pin.flood", "Coolant pin", is_foam ? none() : port ? 1 : 0, "The first free output.");
        output("pin.mist", "Mist pin", none(), "Few machines have both.");
    } else {
        output("pin.torch", "Torch pin", port ? 1 : 0, "The first free output.");
    }
    signals();
}

void Asking::spindle_terminals() {
    const bool port = isPort(), is_modbus = isAsked("spindle.drive") && isChosen("spindle.drive", "modbus");
    if (isChosen("spindle", "none")) {
        return;
    }
    if (!is_modbus && (port || !isAsked("spindle.drive") || isChosen("board", "7i97"))) {
        whole("pin.spindle_on", std::string("Spindle or hot wire pin, ") + (port ? "0: none" : "-1: none"),
              port ? 14 : 2, "", "A free output.");
        within(none(), most_terminals(false));
    }
    if (!isAsked("spindle.drive")) {
        return;
    }
    if (isChosen("spindle.drive", "pwm")) {
        whole("pin.spindle_pwm", "Spindle speed pin (PWM)", 16, "", "A free output.");
        within(1, 17);
        number("spindle.pwm_hz", "PWM frequency", 100, "Hz",
               "Gives enough speed steps with a parallel port.");
        within(1, 5000);
    } else if (isChosen("spindle.drive", "step")) {
        number("spindle.steps_per_turn", "Steps of a spindle revolution", 400, "", "A usual setting.");
        within(1, LONGEST);
        if (port) {
            whole("pin.spindle_pwm", "Spindle step pin", 16, "", "A free output.");
            within(1, 17);
        }
    } else if (is_modbus) {
        choice("spindle.vfd", "Frequency converter", {"gs2_vfd", "vfdb_vfd"}, "The available drivers.");
        text("spindle.device", "Serial device", "/dev/ttyUSB0", "The first adapter that is plugged in.");
    }
    if (is_modbus || isChosen("spindle.drive", "step")) {
        return;
    }
    number("spindle.full_output", "Spindle speed at full output",
           parse_double(answer_of(asked_, given_, "spindle.max")).value_or(12000), "rev/min",
           "As the maximum speed; `millwright commission check` finds it with a tachometer.");
    within(1, 1e6);
}

void Asking::signals() {
    const bool port = isPort();
    const int most_in = most_terminals(true);
    const std::string zero = port ? ", 0: none" : ", -1: none";
    whole("pin.estop", "Emergency stop pin, high while the button is released" + zero, port ? 10 : most_in,
          "", port ? "The first input." : "The last input.");
    within(none(), most_in);
    whole("pin.probe", "Probe pin" + zero, none(), "", "None until a probe is connected.");
    within(none(), most_in);
    choice("probe.contacts", "Probe contact", {"open", "closed"}, "Touch plates close a contact.");
    if (isPlasma()) {
        whole("pin.arc_ok", "Arc OK pin" + zero, next_input(), "", "The next free input.");
        within(none(), most_in);
    }
    if (isChosen("board", "7i76e")) {
        choice("pendant", "Pendant", {"none", "wheel"},
               "A handwheel at the encoder inputs of the field terminals.");
    }
    if (!isChosen("switches", "none")) {
        choice("switch.contacts", "Switch contacts", {"open", "closed"},
               "Closed contacts show a broken wire; open ones are more common in kits.");
    }
}

}  // namespace mw::setup::detail

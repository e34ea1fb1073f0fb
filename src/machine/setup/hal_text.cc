// SPDX-License-Identifier: GPL-2.0-or-later
// The HAL files: loaded components, their order, and the wiring.
#include <fmt/format.h>

#include "base/text.hh"
#include "machine/setup/files.hh"

namespace mw::setup {
namespace {

/// Calls `act` for each motor with its joint number.
template <class Act>
void each_motor(const Plan &plan, Act act) {
    int joint = 0;
    for (const Axis &axis : plan.axes) {
        for (const Motor &motor : axis.motors) {
            act(axis, motor, joint++);
        }
    }
}

constexpr const char *SPDX = "# SPDX-License-Identifier: GPL-2.0-or-later\n";

bool hasEncoder(const Plan &plan) {
    return !plan.is_stepper && plan.kind != "foam" && plan.spindle != Spindle::NONE;
}

std::string tool_change_text(const Plan &plan) {
    std::string text = "\n# Tools: prepared at once";
    if (plan.is_tool_changed_by_hand) {
        text += ", changed by the operator after a question.\n"
                "loadusr -W hal_manualtoolchange\n"
                "net tool-change iocontrol.0.tool-change => hal_manualtoolchange.change\n"
                "net tool-changed hal_manualtoolchange.changed => iocontrol.0.tool-changed\n"
                "net tool-number iocontrol.0.tool-prep-number => hal_manualtoolchange.number\n";
    } else {
        text += " and changed at once, without a question.\n"
                "net tool-change iocontrol.0.tool-change => iocontrol.0.tool-changed\n";
    }
    return text + "net tool-prepare iocontrol.0.tool-prepare => iocontrol.0.tool-prepared\n";
}

// Simulated machines

std::string simulated_spindle() {
    return "\n# A spindle that takes its time to turn as fast as it should, with an encoder for threads.\n"
           "loadrt limit2 names=spindle-ramp\n"
           "loadrt near names=spindle-near\n"
           "loadrt scale names=spindle-rps\n"
           "loadrt sim_spindle names=sim-spindle\n"
           "addf spindle-ramp servo-thread\n"
           "addf spindle-near servo-thread\n"
           "addf spindle-rps servo-thread\n"
           "addf sim-spindle servo-thread\n"
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

std::string simulated_switches(const Plan &plan) {
    std::string names, functions, wires;
    each_motor(plan, [&](const Axis &axis, const Motor &motor, int joint) {
        names += (names.empty() ? "" : ",") + ("switch-" + motor.name);
        functions += fmt::format("addf switch-{} servo-thread\n", motor.name);
        wires += fmt::format("setp switch-{0}.home-pos {1}\n"
                             "setp switch-{0}.hysteresis {2}\n"
                             "net {0}-pos => switch-{0}.cur-pos\n"
                             "net {0}-switch switch-{0}.home-sw => joint.{3}.home-sw-in\n",
                             motor.name, to_text(plan.millimetres(axis.home_at_max ? 20 : -20)),
                             to_text(plan.millimetres(0.1)), joint);
        if (plan.switches == Switches::HOME_AND_LIMITS) {
            wires += fmt::format("net {0}-switch => joint.{1}.{2}-lim-sw-in\n", motor.name, joint,
                                 axis.home_at_max ? "pos" : "neg");
        }
    });
    return fmt::format("\n# Switches, a little past the start position of each motor.\n"
                       "loadrt sim_home_switch names={}\n{}{}",
                       names, functions, wires);
}

std::string simulated_text(const Plan &plan) {
    std::string text = "\n# Each motor is at its commanded position.\n";
    each_motor(plan, [&](const Axis &, const Motor &motor, int joint) {
        text +=
            fmt::format("net {0}-pos joint.{1}.motor-pos-cmd => joint.{1}.motor-pos-fb\n", motor.name, joint);
    });
    text += plan.switches == Switches::NONE ? "" : simulated_switches(plan);
    text += hasEncoder(plan) ? simulated_spindle() : "";
    return text + "\n# No button of emergency stop: that of the screen acts.\n"
                  "net estop-loop iocontrol.0.user-enable-out => iocontrol.0.emc-enable-in\n";
}

// Stepper motors

std::string out_pin(int pin) {
    return fmt::format("parport.0.pin-{:02d}-out", pin);
}

std::string in_pin(int pin, bool inverted = false) {
    return fmt::format("parport.0.pin-{:02d}-in{}", pin, inverted ? "-not" : "");
}

std::string stepper_motor(const Plan &plan, const Motor &motor, int joint) {
    const Stepping &s = plan.stepping;
    std::string text =
        fmt::format("\n# Motor {2}\n"
                    "setp stepgen.{0}.position-scale [JOINT_{0}]STEP_SCALE\n"
                    "setp stepgen.{0}.maxvel [JOINT_{0}]STEPGEN_MAXVEL\n"
                    "setp stepgen.{0}.maxaccel [JOINT_{0}]STEPGEN_MAXACCEL\n"
                    "setp stepgen.{0}.steplen {3}\n"
                    "setp stepgen.{0}.stepspace {4}\n"
                    "setp stepgen.{0}.dirsetup {5}\n"
                    "setp stepgen.{0}.dirhold {6}\n"
                    "net {1}-pos-cmd joint.{0}.motor-pos-cmd => stepgen.{0}.position-cmd\n"
                    "net {1}-pos-fb stepgen.{0}.position-fb => joint.{0}.motor-pos-fb\n"
                    "net {1}-enable joint.{0}.amp-enable-out => stepgen.{0}.enable\n"
                    "net {1}-step stepgen.{0}.step => {7}\n"
                    "net {1}-dir stepgen.{0}.dir => {8}\n",
                    joint, motor.name, to_upper(motor.name), s.step_length_ns, s.step_space_ns,
                    s.dir_setup_ns, s.dir_hold_ns, out_pin(motor.step_pin), out_pin(motor.dir_pin));
    if (plan.switches != Switches::NONE) {
        text += fmt::format("net {}-switch {} => joint.{}.home-sw-in\n", motor.name,
                            in_pin(motor.home_pin, s.contacts_closed), joint);
    }
    if (plan.switches == Switches::HOME_AND_LIMITS) {
        text += fmt::format("# The limit switches of both ends are on the same wire.\n"
                            "net {0}-switch => joint.{1}.neg-lim-sw-in joint.{1}.pos-lim-sw-in\n",
                            motor.name, joint);
    }
    return text;
}

std::string outputs_text(const Plan &plan) {
    const Stepping &s = plan.stepping;
    std::string text;
    if (s.enable_pin != 0) {
        text += fmt::format("\n# The drives have power while the machine is on.\nnet {}-enable => {}\n",
                            plan.axes[0].motors[0].name, out_pin(s.enable_pin));
    }
    if (s.spindle_on_pin != 0) {
        text += fmt::format("\n# Spindle or wire.\nnet spindle-on spindle.0.on => {}\n",
                            out_pin(s.spindle_on_pin));
    }
    if (plan.spindle == Spindle::SPEED) {
        text += fmt::format("\n# Its speed by the width of pulses.\n"
                            "setp pwmgen.0.pwm-freq {}\n"
                            "setp pwmgen.0.scale {}\n"
                            "net spindle-on{} => pwmgen.0.enable\n"
                            "net spindle-speed spindle.0.speed-out-abs => pwmgen.0.value\n"
                            "net spindle-pulses pwmgen.0.pwm => {}\n",
                            to_text(s.pwm_hz), to_text(plan.spindle_max),
                            s.spindle_on_pin == 0 ? " spindle.0.on" : "", out_pin(s.spindle_pwm_pin));
    }
    if (s.flood_pin != 0) {
        text +=
            fmt::format("\n# Coolant.\nnet flood iocontrol.0.coolant-flood => {}\n", out_pin(s.flood_pin));
    }
    text +=
        s.estop_pin != 0
            ? fmt::format("\n# The emergency stop is wired in hardware; this tells the controller of it.\n"
                          "net estop-ok {} => iocontrol.0.emc-enable-in\n",
                          in_pin(s.estop_pin))
            : "\n# No wire of the emergency stop: that of the screen acts.\n"
              "net estop-loop iocontrol.0.user-enable-out => iocontrol.0.emc-enable-in\n";
    return text;
}

std::string stepper_threads(const Plan &plan) {
    const bool has_pwm = plan.spindle == Spindle::SPEED;
    return fmt::format(
        "# The port is a simulated one. For a real one load its driver instead, with pins of the same "
        "names,\n"
        "# and take simulated_wires.hal out of the INI file.\n"
        "loadrt sim_parport names=parport.0\n"
        "loadrt stepgen step_type={}\n"
        "{}"
        "\n"
        "# As often as steps are made: read, make pulses, write.\n"
        "addf parport.0.read base-thread\n"
        "addf stepgen.make-pulses base-thread\n"
        "{}"
        "addf parport.0.write base-thread\n"
        "\n"
        "# As often as positions are calculated.\n"
        "addf stepgen.capture-position servo-thread\n"
        "addf motion-command-handler servo-thread\n"
        "addf motion-controller servo-thread\n"
        "addf stepgen.update-freq servo-thread\n"
        "{}",
        [&] {
            std::string types;
            for (int i = 0; i < plan.joints(); ++i) {
                types += i == 0 ? "0" : ",0";
            }
            return types;
        }(),
        has_pwm ? "loadrt pwmgen output_type=0\n" : "",
        has_pwm ? "addf pwmgen.make-pulses base-thread\n" : "",
        has_pwm ? "addf pwmgen.update servo-thread\n" : "");
}

}  // namespace

std::string hal_text(const Plan &plan) {
    std::string text = SPDX;
    text += "# The parts of the machine and their wiring. `millwright hal watch` shows it while it "
            "runs.\n"
            "loadrt [KINS]KINEMATICS\n";
    if (plan.is_stepper) {
        text += "loadrt [EMCMOT]EMCMOT base_period_nsec=[EMCMOT]BASE_PERIOD "
                "servo_period_nsec=[EMCMOT]SERVO_PERIOD "
                "num_joints=[KINS]JOINTS\n";
        text += stepper_threads(plan);
        each_motor(plan, [&](const Axis &, const Motor &motor, int joint) {
            text += stepper_motor(plan, motor, joint);
        });
        text += outputs_text(plan);
    } else {
        text += "loadrt [EMCMOT]EMCMOT servo_period_nsec=[EMCMOT]SERVO_PERIOD num_joints=[KINS]JOINTS\n"
                "addf motion-command-handler servo-thread\n"
                "addf motion-controller servo-thread\n";
        text += simulated_text(plan);
    }
    return text + tool_change_text(plan);
}

std::string wires_text(const Plan &plan) {
    std::string text = SPDX;
    text += "# Simulates the inputs of a real machine: a button that is not pressed, and "
            "switches.\n";
    const Stepping &s = plan.stepping;
    if (s.estop_pin != 0) {
        text += fmt::format("setp {}-fake 1\n", in_pin(s.estop_pin));
    }
    if (plan.switches == Switches::NONE) {
        return text;
    }
    std::string names, contacts, functions, wires;
    each_motor(plan, [&](const Axis &axis, const Motor &motor, int) {
        const char *const comma = names.empty() ? "" : ",";
        names += comma + ("switch-" + motor.name);
        contacts += comma + ("contact-" + motor.name);
        functions += fmt::format("addf switch-{} servo-thread\n", motor.name);
        wires += fmt::format("setp switch-{0}.home-pos {1}\n"
                             "setp switch-{0}.hysteresis {2}\n"
                             "net {0}-pos-fb => switch-{0}.cur-pos\n",
                             motor.name, to_text(plan.millimetres(axis.home_at_max ? 20 : -20)),
                             to_text(plan.millimetres(0.1)));
        if (s.contacts_closed) {
            functions += fmt::format("addf contact-{} servo-thread\n", motor.name);
            wires += fmt::format("net {0}-touched switch-{0}.home-sw => contact-{0}.in\n"
                                 "net {0}-contact contact-{0}.out => {1}-fake\n",
                                 motor.name, in_pin(motor.home_pin));
        } else {
            wires += fmt::format("net {0}-contact switch-{0}.home-sw => {1}-fake\n", motor.name,
                                 in_pin(motor.home_pin));
        }
    });
    return text + fmt::format("loadrt sim_home_switch names={}\n", names) +
           (s.contacts_closed ? fmt::format("loadrt not names={}\n", contacts) : "") + functions + wires;
}

}  // namespace mw::setup

// SPDX-License-Identifier: GPL-2.0-or-later
// The HAL files of the board, its motors and its switches.
#include <algorithm>

#include <fmt/format.h>

#include "base/text.hh"
#include "machine/setup/detail/hal_parts.hh"

namespace mw::setup::detail {
namespace {

bool hasStepSpindle(const Plan &plan) {
    return plan.spindle == Spindle::SPEED && plan.wiring.spindle.command == SpeedCommand::STEP;
}

std::string port_hal(const Plan &plan) {
    std::string types, controls;
    for (int i = 0; i < plan.joints() + (hasStepSpindle(plan) ? 1 : 0); ++i) {
        types += i == 0 ? "0" : ",0";
        controls += fmt::format("{}{}", i == 0 ? "" : ",", i < plan.joints() ? 'p' : 'v');
    }
    const bool has_pwm = plan.spindle == Spindle::SPEED && plan.wiring.spindle.command == SpeedCommand::PWM;
    return heading("The parallel port, and the step generators on its pins.") +
           (plan.wiring.isSimulated
                ? "# The port is simulated; simulated_wires.hal contains its switches and buttons.\n"
                  "loadrt sim_parport names=parport.0\n"
                : fmt::format("loadrt hal_parport cfg=\"{} out\"\n", plan.wiring.address)) +
           fmt::format("loadrt stepgen step_type={}{}\n", types,
                       hasStepSpindle(plan) ? " ctrl_type=" + controls : "") +
           (has_pwm ? "loadrt pwmgen output_type=0\n" : "");
}

int channels_used(const Plan &plan) {
    int most = 0;
    each_motor(plan, [&](const Axis &, const Motor &motor, int) { most = std::max(most, motor.channel); });
    return most + 1;
}

std::string mesa_config(const Plan &plan) {
    if (plan.board == Board::MESA_7I97) {
        return "num_encoders=6 num_pwmgens=6";
    }
    return fmt::format("num_encoders=1 num_stepgens={} sserial_port_0={}xxxxxxx",
                       hasStepSpindle(plan) ? 5 : channels_used(plan), plan.wiring.hasWheel ? 2 : 0);
}

std::string mesa_hal(const Plan &plan) {
    const std::string board = board_name(plan);
    const std::string model = plan.board == Board::MESA_7I97 ? "7i97" : "7i76e";
    std::string text =
        heading(fmt::format("The Mesa {} on the network.", to_upper(model))) + "loadrt hostmot2\n" +
        fmt::format("# virtual_board: the board that doctor and test runs simulate; not used in realtime.\n"
                    "loadrt hm2_eth board_ip=[HOSTMOT2]BOARD_IP config=\"{}\" virtual_board={}:{}\n",
                    mesa_config(plan), model, MOTORS_FILE) +
        fmt::format("\n# Watchdog: without a write for this time the board switches its outputs off [ns].\n"
                    "setp {}.watchdog.timeout_ns 20000000\n",
                    board) +
        fmt::format("\n# Fault: the board does not answer, or has switched its outputs off.\n"
                    "loadrt {} names=board-fault\n"
                    "loadrt not names=board-ok\n"
                    "net packets-lost {}.packet-error-exceeded => board-fault.in0\n"
                    "net watchdog-bitten {}.watchdog.has_bit => board-fault.in1\n",
                    "or2", board, board) +
        "net board-fault board-fault.out => board-ok.in\n"
        "net board-ok board-ok.out\n";
    if (plan.board == Board::MESA_7I97) {
        text += fmt::format(
            "\n# The analog outputs of the drives [Hz].\nsetp {}.pwmgen.pwm_frequency 20000\n", board);
    }
    return text;
}

std::string step_times(const Plan &plan, const std::string &generator) {
    const Wiring &w = plan.wiring;
    return fmt::format(
        "setp {0}.steplen {1}\nsetp {0}.stepspace {2}\nsetp {0}.dirsetup {3}\nsetp {0}.dirhold {4}\n",
        generator, w.step_length_ns, w.step_space_ns, w.dir_setup_ns, w.dir_hold_ns);
}

std::string stepper_text(const Plan &plan, const Motor &motor, int joint) {
    const std::string generator = stepgen_name(plan, motor, joint);
    std::string text = fmt::format("\n# Motor {1}\n"
                                   "setp {2}.position-scale [JOINT_{0}]STEP_SCALE\n"
                                   "setp {2}.maxvel [JOINT_{0}]STEPGEN_MAXVEL\n"
                                   "setp {2}.maxaccel [JOINT_{0}]STEPGEN_MAXACCEL\n",
                                   joint, to_upper(motor.name), generator) +
                       step_times(plan, generator) +
                       fmt::format("net {1}-pos-cmd joint.{0}.motor-pos-cmd => {2}.position-cmd\n"
                                   "net {1}-pos-fb {2}.position-fb => joint.{0}.motor-pos-fb\n"
                                   "net {1}-enable joint.{0}.amp-enable-out => {2}.enable\n",
                                   joint, motor.name, generator);
    if (plan.board == Board::PARPORT) {
        text +=
            fmt::format("net {0}-step {1}.step => {2}\n"
                        "net {0}-dir {1}.dir => {3}\n",
                        motor.name, generator, out_pin(plan, motor.step_pin), out_pin(plan, motor.dir_pin));
    }
    return text;
}

std::string servo_text(const Plan &plan, const Motor &motor, int joint) {
    const std::string output = servo_output_name(plan, motor.channel);
    const std::string encoder = fmt::format("{}.encoder.{:02d}", board_name(plan), motor.channel);
    return fmt::format("\n# Motor {1}: the controller output is a speed [machine units/s].\n"
                       "setp pid-{2}.Pgain [JOINT_{0}]P\n"
                       "setp pid-{2}.Igain [JOINT_{0}]I\n"
                       "setp pid-{2}.Dgain [JOINT_{0}]D\n"
                       "setp pid-{2}.FF1 [JOINT_{0}]FF1\n"
                       "setp pid-{2}.FF2 [JOINT_{0}]FF2\n"
                       "setp pid-{2}.maxoutput [JOINT_{0}]MAX_OUTPUT\n"
                       "setp pid-{2}.error-previous-target true\n"
                       "setp {3}.scale [JOINT_{0}]OUTPUT_SCALE\n"
                       "setp {4}.scale [JOINT_{0}]ENCODER_SCALE\n"
                       "net {2}-pos-cmd joint.{0}.motor-pos-cmd => pid-{2}.command\n"
                       "net {2}-pos-fb {4}.position => pid-{2}.feedback joint.{0}.motor-pos-fb\n"
                       "net {2}-speed pid-{2}.output => {3}.value\n"
                       "net {2}-enable joint.{0}.amp-enable-out => pid-{2}.enable {3}.enable\n",
                       joint, to_upper(motor.name), motor.name, output, encoder);
}

}  // namespace

std::string board_hal(const Plan &plan) {
    return plan.board == Board::PARPORT ? port_hal(plan) : mesa_hal(plan);
}

std::string motors_hal(const Plan &plan) {
    std::string text = heading(
        plan.is_servo ? "Servo motors: commands of motion to the drives, encoders back to motion."
                      : "Stepper motors: commands of motion to the step generators, and their count back.");
    if (plan.is_servo) {
        std::string names;
        each_motor(plan, [&](const Axis &, const Motor &motor, int) {
            names += (names.empty() ? "pid-" : ",pid-") + motor.name;
        });
        text += "loadrt pid names=" + names + "\n";
    }
    each_motor(plan, [&](const Axis &, const Motor &motor, int joint) {
        text += plan.is_servo ? servo_text(plan, motor, joint) : stepper_text(plan, motor, joint);
    });
    if (plan.wiring.enable_pin.has_value()) {
        text += fmt::format("\n# The drives have power while the machine is on.\n"
                            "net drives-enable motion.motion-enabled => {}\n",
                            out_pin(plan, *plan.wiring.enable_pin));
    }
    return text;
}

std::string switches_hal(const Plan &plan) {
    if (plan.switches == Switches::NONE) {
        return {};
    }
    std::string text = heading(plan.switches == Switches::HOME_AND_LIMITS
                                   ? "Home switches. The limit switches of both ends are on the same wire."
                                   : "Home switches.");
    each_motor(plan, [&](const Axis &, const Motor &motor, int joint) {
        if (!motor.home_pin.has_value()) {
            return;
        }
        text += fmt::format("\n# Motor {}: the contact {} when the switch is actuated.\n"
                            "net {}-switch {} => joint.{}.home-sw-in\n",
                            to_upper(motor.name), motor.home_contact_closed ? "opens" : "closes", motor.name,
                            in_pin(plan, *motor.home_pin, motor.home_contact_closed), joint);
        if (plan.switches == Switches::HOME_AND_LIMITS) {
            text += fmt::format("net {0}-switch => joint.{1}.neg-lim-sw-in joint.{1}.pos-lim-sw-in\n",
                                motor.name, joint);
        }
    });
    return text;
}

}  // namespace mw::setup::detail

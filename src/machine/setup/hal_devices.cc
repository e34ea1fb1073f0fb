// SPDX-License-Identifier: GPL-2.0-or-later
// The HAL files of spindle, torch, coolant, emergency stop, probe and pendant.
#include <fmt/format.h>

#include "base/text.hh"
#include "machine/setup/detail/hal_parts.hh"

namespace mw::setup::detail {
namespace {

std::string analog_text(const Plan &plan) {
    const std::string scale = "[SPINDLE_0]FULL_OUTPUT";
    if (plan.board == Board::MESA_7I97) {
        return fmt::format("\n# Spindle speed at the last analog output.\n"
                           "setp {0}.scale {1}\n"
                           "net spindle-speed spindle.0.speed-out => {0}.value\n"
                           "net spindle-on => {0}.enable\n",
                           servo_output_name(plan, 5), scale);
    }
    const std::string terminals = board_name(plan) + ".7i76.0.0";
    return fmt::format("\n# Spindle speed, run and direction at the spindle terminals.\n"
                       "setp {0}.spinout-scalemax {1}\n"
                       "setp {0}.spinout-maxlim {1}\n"
                       "net spindle-speed spindle.0.speed-out-abs => {0}.spinout\n"
                       "net spindle-on => {0}.spinena\n"
                       "net spindle-reverse spindle.0.reverse => {0}.spindir\n",
                       terminals, scale);
}

std::string pwm_text(const Plan &plan) {
    const SpindleWiring &spindle = plan.wiring.spindle;
    return fmt::format("\n# Spindle speed as pulse width.\n"
                       "setp pwmgen.0.pwm-freq {}\n"
                       "setp pwmgen.0.scale [SPINDLE_0]FULL_OUTPUT\n"
                       "net spindle-on => pwmgen.0.enable\n"
                       "net spindle-speed spindle.0.speed-out-abs => pwmgen.0.value\n"
                       "net spindle-pulses pwmgen.0.pwm => {}\n",
                       to_text(spindle.pwm_hz), out_pin(plan, spindle.speed_pin.value_or(16)));
}

std::string step_text(const Plan &plan) {
    const SpindleWiring &spindle = plan.wiring.spindle;
    const std::string generator = spindle_stepgen_name(plan);
    std::string text = fmt::format("\n# Spindle speed as step rate [rev/s].\n"
                                   "setp {0}.position-scale {1}\n"
                                   "setp {0}.maxaccel 20\n"
                                   "setp {0}.steplen {2}\n"
                                   "setp {0}.stepspace {3}\n"
                                   "net spindle-on => {0}.enable\n"
                                   "net spindle-speed-rps spindle.0.speed-out-rps => {0}.velocity-cmd\n",
                                   generator, to_text(spindle.steps_per_turn), plan.wiring.step_length_ns,
                                   plan.wiring.step_space_ns);
    if (plan.board == Board::PARPORT) {
        text += fmt::format("net spindle-step {}.step => {}\n", generator,
                            out_pin(plan, spindle.speed_pin.value_or(16)));
    } else {
        text += fmt::format("setp {}.control-type 1\n", generator);
    }
    return text;
}

std::string modbus_text(const Plan &plan) {
    const SpindleWiring &spindle = plan.wiring.spindle;
    const bool is_gs2 = spindle.vfd == "gs2_vfd";
    return fmt::format("\n# The frequency converter on a serial line.\n"
                       "loadusr -Wn spindle-vfd {} --name spindle-vfd --device {}\n"
                       "net spindle-speed spindle.0.speed-out-abs => spindle-vfd.speed-command\n"
                       "net spindle-on => spindle-vfd.spindle-on spindle-vfd.enable\n"
                       "{}"
                       "net spindle-at-speed spindle-vfd.at-speed => spindle.0.at-speed\n",
                       spindle.vfd, spindle.device,
                       is_gs2 ? "net spindle-forward spindle.0.forward => spindle-vfd.spindle-fwd\n"
                                "net spindle-reverse spindle.0.reverse => spindle-vfd.spindle-rev\n"
                              : "");
}

}  // namespace

std::string spindle_hal(const Plan &plan) {
    if (plan.spindle == Spindle::NONE) {
        return {};
    }
    const SpindleWiring &spindle = plan.wiring.spindle;
    std::string text = heading(plan.kind == "foam" ? "The hot wire." : "The spindle.");
    text += "net spindle-on spindle.0.on";
    text += spindle.on_pin.has_value() ? " => " + out_pin(plan, *spindle.on_pin) + "\n" : "\n";
    if (plan.spindle == Spindle::ON_OFF) {
        return text;
    }
    switch (spindle.command) {
    case SpeedCommand::PWM: return text + pwm_text(plan);
    case SpeedCommand::ANALOG: return text + analog_text(plan);
    case SpeedCommand::STEP: return text + step_text(plan);
    case SpeedCommand::MODBUS: return text + modbus_text(plan);
    }
    return text;
}

std::string torch_hal(const Plan &plan) {
    const Wiring &w = plan.wiring;
    if (!w.torch_pin.has_value()) {
        return {};
    }
    std::string text = heading("The torch: on with M3, off with M5.") +
                       fmt::format("net torch-on spindle.0.on => {}\n", out_pin(plan, *w.torch_pin));
    if (w.arc_ok_pin.has_value()) {
        text += fmt::format("# M66 P0 waits for the arc.\n"
                            "net arc-ok {} => motion.digital-in-00\n",
                            in_pin(plan, *w.arc_ok_pin));
    }
    return text;
}

std::string coolant_hal(const Plan &plan) {
    const Wiring &w = plan.wiring;
    std::string text;
    if (w.flood_pin.has_value()) {
        text += fmt::format("net flood iocontrol.0.coolant-flood => {}\n", out_pin(plan, *w.flood_pin));
    }
    if (w.mist_pin.has_value()) {
        text += fmt::format("net mist iocontrol.0.coolant-mist => {}\n", out_pin(plan, *w.mist_pin));
    }
    return text.empty() ? text : heading("Coolant.") + text;
}

std::string estop_hal(const Plan &plan) {
    const Terminal &pin = plan.wiring.estop_pin;
    const bool is_mesa = plan.hasBoard() && plan.board != Board::PARPORT;
    std::string text = heading("The emergency stop is wired in hardware; this reports it to the controller.");
    if (!pin.has_value()) {
        text += "# No emergency stop input: only the button of the screen is used.\n";
    }
    const std::string source = pin.has_value()
                                   ? "net estop-released " + in_pin(plan, *pin)
                                   : std::string("net estop-released iocontrol.0.user-enable-out");
    if (!is_mesa) {
        return text + source + " => iocontrol.0.emc-enable-in\n";
    }
    return text +
           "# A fault of the board is also an emergency stop.\n"
           "loadrt and2 names=estop-chain\n" +
           source +
           " => estop-chain.in0\n"
           "net board-ok => estop-chain.in1\n"
           "net machine-may-be-on estop-chain.out => iocontrol.0.emc-enable-in\n";
}

std::string probe_hal(const Plan &plan) {
    const Wiring &w = plan.wiring;
    if (!w.probe_pin.has_value()) {
        return {};
    }
    return heading("The probe.") + fmt::format("net probe-touched {} => motion.probe-input\n",
                                               in_pin(plan, *w.probe_pin, w.probe_contact_closed));
}

std::string pendant_hal(const Plan &plan) {
    if (!plan.wiring.hasWheel) {
        return {};
    }
    std::string text =
        heading(
            "A handwheel at the encoder inputs of the field terminals; inputs 16 and up select the axis.") +
        "loadrt constant names=wheel-step\n" +
        fmt::format("# Travel per count.\nsetp wheel-step.value {}\n"
                    "net wheel-step wheel-step.out\n"
                    "net wheel-counts {}.7i76.0.0.enc0.count\n",
                    to_text(plan.millimetres(0.0254 / 2.54)), board_name(plan));
    constexpr int FIRST_INPUT = 16;
    int place = FIRST_INPUT;
    each_motor(plan, [&](const Axis &axis, const Motor &motor, int joint) {
        if (motor.name.size() > 1) {
            return;
        }
        const std::string letter = to_lower(std::string(1, axis.letter));
        text += fmt::format("\nnet {0}-wheel-selected {1} => joint.{2}.jog-enable axis.{0}.jog-enable\n"
                            "net wheel-counts => joint.{2}.jog-counts axis.{0}.jog-counts\n"
                            "net wheel-step => joint.{2}.jog-scale axis.{0}.jog-scale\n",
                            letter, in_pin(plan, place++), joint);
    });
    return text;
}

}  // namespace mw::setup::detail

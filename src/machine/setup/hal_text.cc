// SPDX-License-Identifier: GPL-2.0-or-later
// The HAL files of motion and tools, and the order of the functions.
#include <algorithm>

#include <fmt/format.h>

#include "base/text.hh"
#include "machine/setup/detail/hal_parts.hh"

namespace mw::setup::detail {

std::string heading(const std::string &purpose) {
    return "# SPDX-License-Identifier: GPL-2.0-or-later\n# " + purpose + "\n";
}

std::string board_name(const Plan &plan) {
    return plan.board == Board::MESA_7I76E  ? "hm2_7i76e.0"
           : plan.board == Board::MESA_7I97 ? "hm2_7i97.0"
                                            : "parport.0";
}

std::string in_pin(const Plan &plan, int number, bool inverted) {
    const char *const ending = inverted ? "-not" : "";
    switch (plan.board) {
    case Board::MESA_7I76E: return fmt::format("hm2_7i76e.0.7i76.0.0.input-{:02d}{}", number, ending);
    case Board::MESA_7I97: return fmt::format("hm2_7i97.0.inmux.00.input-{:02d}{}", number, ending);
    default: return fmt::format("parport.0.pin-{:02d}-in{}", number, ending);
    }
}

std::string out_pin(const Plan &plan, int number) {
    switch (plan.board) {
    case Board::MESA_7I76E: return fmt::format("hm2_7i76e.0.7i76.0.0.output-{:02d}", number);
    case Board::MESA_7I97: return fmt::format("hm2_7i97.0.ssr.00.out-{:02d}", number);
    default: return fmt::format("parport.0.pin-{:02d}-out", number);
    }
}

std::string stepgen_name(const Plan &plan, const Motor &motor, int joint) {
    return plan.board == Board::PARPORT ? fmt::format("stepgen.{}", joint)
                                        : fmt::format("{}.stepgen.{:02d}", board_name(plan), motor.channel);
}

std::string servo_output_name(const Plan &plan, int channel) {
    return fmt::format("{}.pwmgen.{:02d}", board_name(plan), channel);
}

std::string spindle_stepgen_name(const Plan &plan) {
    return plan.board == Board::PARPORT ? fmt::format("stepgen.{}", plan.joints())
                                        : board_name(plan) + ".stepgen.04";
}

bool hasSimulatedEncoder(const Plan &plan) {
    return !plan.hasBoard() && plan.kind != "foam" && plan.spindle != Spindle::NONE;
}

std::string motion_hal(const Plan &plan) {
    return heading("Kinematics and the motion controller, with a thread for each period of the INI file.") +
           "loadrt [KINS]KINEMATICS\n"
           "loadrt [EMCMOT]EMCMOT " +
           (plan.hasBaseThread() ? "base_period_nsec=[EMCMOT]BASE_PERIOD " : "") +
           "servo_period_nsec=[EMCMOT]SERVO_PERIOD num_joints=[KINS]JOINTS\n";
}

std::string tool_change_hal(const Plan &plan) {
    if (plan.is_tool_changed_by_hand) {
        return heading("Tools: prepared at once, changed by the operator after a question.") +
               "loadusr -W hal_manualtoolchange\n"
               "net tool-change iocontrol.0.tool-change => hal_manualtoolchange.change\n"
               "net tool-changed hal_manualtoolchange.changed => iocontrol.0.tool-changed\n"
               "net tool-number iocontrol.0.tool-prep-number => hal_manualtoolchange.number\n"
               "net tool-prepare iocontrol.0.tool-prepare => iocontrol.0.tool-prepared\n";
    }
    return heading("Tools: prepared and changed at once, without a question.") +
           "net tool-change iocontrol.0.tool-change => iocontrol.0.tool-changed\n"
           "net tool-prepare iocontrol.0.tool-prepare => iocontrol.0.tool-prepared\n";
}

namespace {

class Threads {
  public:
    explicit Threads(const Plan &plan) : plan_(plan) {}

    std::string text() {
        if (plan_.hasBaseThread()) {
            base();
        }
        text_ += "\n# In each servo period: read, calculate, write.\n";
        read();
        add("motion-command-handler");
        add("motion-controller");
        calculate();
        write();
        return text_;
    }

  private:
    void add(const std::string &function, const char *thread = "servo-thread") {
        text_ += fmt::format("addf {} {}\n", function, thread);
    }
    bool hasPwm() const {
        return plan_.spindle == Spindle::SPEED && plan_.wiring.spindle.command == SpeedCommand::PWM;
    }
    void base() {
        text_ += "\n# In each base period: read, make step pulses, write.\n";
        add("parport.0.read", "base-thread");
        add("stepgen.make-pulses", "base-thread");
        if (hasPwm()) {
            add("pwmgen.make-pulses", "base-thread");
        }
        add("parport.0.write", "base-thread");
    }
    void read() {
        if (plan_.board == Board::PARPORT) {
            add("stepgen.capture-position");
        } else if (plan_.hasBoard()) {
            add(board_name(plan_) + ".read");
        }
    }
    void calculate() {
        if (plan_.is_servo) {
            each_motor(plan_, [&](const Axis &, const Motor &motor, int) {
                add(fmt::format("pid-{}.do-pid-calcs", motor.name));
            });
        }
        if (plan_.board == Board::MESA_7I76E || plan_.board == Board::MESA_7I97) {
            add("board-fault");
            add("board-ok");
            add("estop-chain");
        }
        if (!plan_.hasBoard() && plan_.switches != Switches::NONE) {
            each_motor(plan_, [&](const Axis &, const Motor &motor, int) { add("switch-" + motor.name); });
        }
        if (hasSimulatedEncoder(plan_)) {
            for (const char *part : {"spindle-ramp", "spindle-near", "spindle-rps", "sim-spindle"}) {
                add(part);
            }
        }
        if (plan_.wiring.hasWheel) {
            add("wheel-step");
        }
    }
    void write() {
        if (plan_.board == Board::PARPORT) {
            add("stepgen.update-freq");
            if (hasPwm()) {
                add("pwmgen.update");
            }
        } else if (plan_.hasBoard()) {
            add(board_name(plan_) + ".write");
        }
    }

    const Plan &plan_;
    std::string text_ = heading("The order of the functions in the threads.");
};

}  // namespace

std::string threads_hal(const Plan &plan) {
    return Threads(plan).text();
}

}  // namespace mw::setup::detail

namespace mw::setup {

std::vector<File> hal_files(const Plan &plan) {
    using namespace detail;
    const bool simulated_board = plan.hasBoard() && plan.wiring.isSimulated;
    const bool is_mesa = plan.hasBoard() && plan.board != Board::PARPORT;
    std::vector<File> files{{"motion.hal", motion_hal(plan)}};
    const auto add = [&](const char *name, std::string text) {
        if (!text.empty()) {
            files.push_back({name, std::move(text)});
        }
    };
    if (plan.hasBoard()) {
        if (simulated_board && is_mesa) {
            add("simulated_board.hal", simulated_board_hal(plan));
        }
        add("board.hal", board_hal(plan));
        add("motors.hal", motors_hal(plan));
        add("switches.hal", switches_hal(plan));
        add("spindle.hal", spindle_hal(plan));
        add("torch.hal", torch_hal(plan));
        add("coolant.hal", coolant_hal(plan));
        add("probe.hal", probe_hal(plan));
        add("pendant.hal", pendant_hal(plan));
    } else {
        add("motors.hal", simulated_motors_hal(plan));
        add("switches.hal", simulated_switches_hal(plan));
        add("spindle.hal", simulated_spindle_hal(plan));
    }
    add("estop.hal", estop_hal(plan));
    add("tool_change.hal", tool_change_hal(plan));
    add("threads.hal", threads_hal(plan));
    if (simulated_board && !is_mesa) {
        add("simulated_wires.hal", simulated_wires_hal(plan));
    }
    return files;
}

}  // namespace mw::setup

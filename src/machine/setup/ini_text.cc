// SPDX-License-Identifier: GPL-2.0-or-later
// The INI file: every key with its unit, in a useful order.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/text.hh"
#include "machine/setup/files.hh"

namespace mw::setup {
namespace {

/// Numbers with only the necessary digits.
std::string short_text(double value) {
    return to_text(parse_double(fmt::format("{:.6g}", value)).value_or(value));
}

const char *length_unit(const Plan &plan) {
    return plan.metric ? "mm" : "inch";
}

std::string letters(const Plan &plan, const char *between) {
    std::string text;
    for (const Axis &axis : plan.axes) {
        for (std::size_t i = 0; i < axis.motors.size(); ++i) {
            text += text.empty() ? "" : between;
            text += axis.letter;
        }
    }
    return text;
}

std::string display_text(const Plan &plan) {
    const char *const increments =
        plan.metric ? "10 mm, 1 mm, 0.1 mm, 0.01 mm" : "1 in, 0.1 in, 0.01 in, 0.001 in";
    std::string text = fmt::format("[DISPLAY]\n"
                                   "# The operator's screen, in a browser.\n"
                                   "DISPLAY = millwright\n"
                                   "# Folder of programs and subroutines.\n"
                                   "PROGRAM_PREFIX = nc_files\n"
                                   "# Jog increments of the screen.\n"
                                   "INCREMENTS = {}\n"
                                   "# Maximum feed override: 1.2 is 120 %.\n"
                                   "MAX_FEED_OVERRIDE = 1.2\n",
                                   increments);
    if (plan.spindle == Spindle::SPEED) {
        text += fmt::format("# Maximum and default speed of the spindle [rev/min].\n"
                            "MAX_SPINDLE_SPEED = {0}\n"
                            "DEFAULT_SPINDLE_SPEED = {1}\n",
                            short_text(plan.spindle_max), short_text(plan.spindle_max / 4));
    }
    if (plan.kind == "lathe") {
        text += "# The drawing shows Z to the right and X (a radius) up.\n"
                "LATHE = 1\n";
    }
    if (plan.kind == "foam") {
        text += fmt::format("# X and Y move one end of the wire, U and V the other.\n"
                            "FOAM = 1\n"
                            "GEOMETRY = XY;UV\n"
                            "FOAM_Z = 0\n"
                            "FOAM_W = {}\n",
                            short_text(plan.foam_width));
    }
    return text + '\n';
}

std::string system_text(const Plan &plan) {
    std::string text =
        "[TASK]\n"
        "TASK = milltask\n"
        "# Period of task [s].\n"
        "CYCLE_TIME = 0.001\n"
        "\n"
        "[RS274NGC]\n"
        "# File of offsets and parameters that are kept after a restart; the machine writes it.\n"
        "PARAMETER_FILE = machine.var\n"
        "SUBROUTINE_PATH = nc_files\n"
        "\n"
        "[EMCMOT]\n"
        "EMCMOT = motmod\n"
        "# Only used by LinuxCNC [s].\n"
        "COMM_TIMEOUT = 1.0\n"
        "# Period of the motion controller [ns].\n"
        "SERVO_PERIOD = 1000000\n";
    if (plan.hasBaseThread()) {
        text += fmt::format("# Period of step generation [ns]: latency of the computer, step time, and run "
                            "time of the thread.\n"
                            "BASE_PERIOD = {}\n",
                            plan.wiring.base_period_ns);
    }
    text += "\n[EMCIO]\nTOOL_TABLE = tool.tbl\n\n"
            "[HAL]\n"
            "# HAL files in the order of execution. Each file is for one function of the machine.\n";
    for (const File &file : hal_files(plan)) {
        text += file.name.starts_with("simulated_")
                    ? "# Simulated hardware. Remove this line when the real board is connected.\n"
                    : "";
        text += "HALFILE = " + file.name + "\n";
    }
    text += "# Pins for additional buttons: halui.*\nHALUI = halui\n\n";
    if (plan.hasBoard() && plan.board != Board::PARPORT) {
        text += fmt::format("[HOSTMOT2]\n"
                            "# The board on the network.{}\n"
                            "BOARD_IP = {}\n\n",
                            plan.wiring.isSimulated ? " 127.0.0.1: a simulated board on this computer." : "",
                            plan.wiring.isSimulated ? "127.0.0.1" : plan.wiring.address);
    }
    const double full_output = plan.wiring.spindle.full_output;
    if (full_output > 0) {
        text += fmt::format("[SPINDLE_0]\n"
                            "# Speed at full output [rev/min], measured with a tachometer.\n"
                            "FULL_OUTPUT = {}\n"
                            "MAX_FORWARD_VELOCITY = {}\n\n",
                            to_text(full_output), short_text(plan.spindle_max));
    }
    return text;
}

/// Speeds along paths of only rotary axes.
std::string angular_text(const Plan &plan) {
    double speed = 0, acceleration = 0;
    for (const Axis &axis : plan.axes) {
        speed = std::max(speed, axis.isRotary() ? axis.speed : 0);
        acceleration = std::max(acceleration, axis.isRotary() ? axis.acceleration : 0);
    }
    return speed == 0 ? ""
                      : fmt::format("# Limits of rotary axes [deg/s], [deg/s2].\n"
                                    "DEFAULT_ANGULAR_VELOCITY = {}\n"
                                    "MAX_ANGULAR_VELOCITY = {}\n"
                                    "MAX_ANGULAR_ACCELERATION = {}\n",
                                    short_text(speed / 4), short_text(speed), short_text(acceleration));
}

std::string whole_text(const Plan &plan) {
    const bool is_gantry = plan.kind == "gantry";
    double acceleration = 0;
    for (const Axis &axis : plan.axes) {
        acceleration = std::max(acceleration, axis.isRotary() ? 0 : axis.acceleration);
    }
    return fmt::format("[TRAJ]\n"
                       "COORDINATES = {}\n"
                       "LINEAR_UNITS = {}\n"
                       "ANGULAR_UNITS = degree\n"
                       "# Default jog speed; maximum speed along a path [{}/s]; acceleration [{}/s2].\n"
                       "DEFAULT_LINEAR_VELOCITY = {}\n"
                       "MAX_LINEAR_VELOCITY = {}\n"
                       "MAX_LINEAR_ACCELERATION = {}\n"
                       "{}"
                       "\n"
                       "[KINS]\n"
                       "{}"
                       "KINEMATICS = trivkins coordinates={}{}\n"
                       "JOINTS = {}\n"
                       "\n",
                       letters(plan, " "), length_unit(plan), length_unit(plan), length_unit(plan),
                       short_text(plan.fastest() / 4), short_text(plan.fastest()), short_text(acceleration),
                       angular_text(plan),
                       is_gantry ? "# Each motor is a joint; the two motors of Y move together.\n"
                                 : "# Each motor is a joint.\n",
                       letters(plan, ""), is_gantry ? " kinstype=BOTH" : "", plan.joints());
}

/// Upper axes home first, so that nothing obstructs sideways moves; motors of one axis home together.
int home_sequence(const Plan &plan, const Axis &axis) {
    const bool first = plan.kind == "lathe"  ? axis.letter == 'X'
                       : plan.kind == "foam" ? axis.letter == 'Y' || axis.letter == 'V'
                                             : axis.letter == 'Z';
    if (axis.motors.size() > 1) {
        return -2;
    }
    return first ? 0 : 1;
}

/// A speed at which the axis moves less than a third of a count in a servo period, so that homing repeats
/// within one count.
double latch_speed(const Axis &axis) {
    constexpr double PERIODS_PER_S = 1000, COUNTS = 0.3, SLOWER = 10, SLOWEST = 100;
    double speed = axis.home_speed / SLOWER;
    for (const Motor &motor : axis.motors) {
        const double counts = std::max(std::abs(motor.steps_per_unit), std::abs(motor.servo.counts_per_unit));
        speed = counts > 0 ? std::min(speed, COUNTS * PERIODS_PER_S / counts) : speed;
    }
    return std::max(speed, axis.home_speed / SLOWEST);
}

std::string home_text(const Plan &plan, const Axis &axis) {
    const int sequence = home_sequence(plan, axis);
    const char *const order = sequence < 0
                                  ? "# Order of homing; negative: these motors finish homing together.\n"
                                  : "# Order of homing; joints with equal numbers home together.\n";
    if (plan.switches == Switches::NONE) {
        const std::string place = short_text(std::clamp(0.0, axis.min, axis.max));
        return fmt::format("# No home switch: homing uses the current position of the motor.\n"
                           "HOME = {0}\n"
                           "HOME_OFFSET = {0}\n"
                           "HOME_SEARCH_VEL = 0\n"
                           "HOME_LATCH_VEL = 0\n"
                           "{1}HOME_SEQUENCE = {2}\n",
                           place, order, sequence);
    }
    const double sign = axis.home_at_max ? 1 : -1, end = axis.home_at_max ? axis.max : axis.min;
    return fmt::format(
        "# The home switch is at HOME_OFFSET. After homing the axis moves to HOME.\n"
        "HOME = {}\n"
        "HOME_OFFSET = {}\n"
        "# Search speed, and latch speed (less than a count per period); the sign is the direction.\n"
        "HOME_SEARCH_VEL = {}\n"
        "HOME_LATCH_VEL = {}\n"
        "{}{}HOME_SEQUENCE = {}\n",
        short_text(end - sign * plan.small(axis, 1)), short_text(end + sign * plan.small(axis, 2)),
        short_text(sign * axis.home_speed), short_text(sign * latch_speed(axis)),
        plan.switches == Switches::HOME_AND_LIMITS
            ? "# The home switch is also a limit switch, except during homing.\nHOME_IGNORE_LIMITS = YES\n"
            : "",
        order, sequence);
}

std::string stepper_text(const Plan &plan, const Axis &axis, const Motor &motor) {
    return fmt::format("# Steps per {}; negative: the motor is reversed.\n"
                       "STEP_SCALE = {}\n"
                       "# Limits of the step generator, with a reserve for following the command.\n"
                       "STEPGEN_MAXVEL = {}\n"
                       "STEPGEN_MAXACCEL = {}\n",
                       axis.isRotary() ? "degree" : length_unit(plan), to_text(motor.steps_per_unit),
                       short_text(axis.speed * 1.05), short_text(axis.acceleration * 1.25));
}

std::string servo_text(const Plan &plan, const Axis &axis, const Motor &motor) {
    const Servo &servo = motor.servo;
    return fmt::format("# Counts per {}; negative: the encoder is reversed.\n"
                       "ENCODER_SCALE = {}\n"
                       "# Speed at 10 V; negative: the command is reversed.\n"
                       "OUTPUT_SCALE = {}\n"
                       "MAX_OUTPUT = {}\n"
                       "# Gains of the position controller, whose output is a speed.\n"
                       "P = {}\n"
                       "I = {}\n"
                       "D = {}\n"
                       "FF1 = {}\n"
                       "FF2 = {}\n",
                       axis.isRotary() ? "degree" : length_unit(plan), to_text(servo.counts_per_unit),
                       short_text(servo.full_speed), short_text(std::abs(servo.full_speed)),
                       short_text(servo.p), short_text(servo.i), short_text(servo.d), short_text(servo.ff1),
                       short_text(servo.ff2));
}

std::string joint_text(const Plan &plan, const Axis &axis, const Motor &motor, int joint) {
    // Until it is tuned, a servo axis lags behind by the speed divided by the gain.
    const double lag = plan.is_servo ? axis.speed / std::max(motor.servo.p, 1.0) * 1.5 : 0;
    std::string text = fmt::format(
        "# Motor {}\n"
        "[JOINT_{}]\n"
        "TYPE = {}\n"
        "MAX_VELOCITY = {}\n"
        "MAX_ACCELERATION = {}\n"
        "MIN_LIMIT = {}\n"
        "MAX_LIMIT = {}\n"
        "# Maximum following error at full speed, and at low speed. If it is exceeded, the machine is "
        "switched off.\n"
        "FERROR = {}\n"
        "MIN_FERROR = {}\n",
        to_upper(motor.name), joint, axis.isRotary() ? "ANGULAR" : "LINEAR", short_text(axis.speed),
        short_text(axis.acceleration), short_text(axis.min), short_text(axis.max),
        short_text(plan.small(axis, 1) + lag), short_text(plan.small(axis, 0.25) + lag));
    text += plan.is_stepper ? stepper_text(plan, axis, motor)
            : plan.is_servo ? servo_text(plan, axis, motor)
                            : "";
    if (motor.backlash > 0) {
        text += fmt::format("# Backlash between motor and table.\n"
                            "BACKLASH = {}\n",
                            short_text(motor.backlash));
    }
    return text + home_text(plan, axis) + '\n';
}

}  // namespace

/// The device that moves the machine.
static const char *machine_text(const Plan &plan) {
    switch (plan.board) {
    case Board::PARPORT: return "stepper motors at a parallel port";
    case Board::MESA_7I76E: return "stepper motors at a Mesa 7I76E";
    case Board::MESA_7I97: return "servo motors at a Mesa 7I97";
    default: return "simulated";
    }
}

std::string ini_text(const Plan &plan) {
    std::string text =
        fmt::format("# SPDX-License-Identifier: GPL-2.0-or-later\n"
                    "# {}: {}, {}, {}. Written by `millwright setup`. You may edit it.\n"
                    "# Lengths are in {}, speeds in {} per second. docs/reference/ini.md has all keys.\n"
                    "[EMC]\n"
                    "VERSION = 1.1\n"
                    "MACHINE = {}\n"
                    "DEBUG = 0\n\n",
                    plan.name, plan.kind, plan.metric ? "metric" : "in inches", machine_text(plan),
                    length_unit(plan), length_unit(plan), plan.name);
    text += display_text(plan) + system_text(plan) + whole_text(plan);
    int joint = 0;
    for (const Axis &axis : plan.axes) {
        text += fmt::format("[AXIS_{}]\n"
                            "# Limits of travel, speed and acceleration for programs and jogs.\n"
                            "MIN_LIMIT = {}\n"
                            "MAX_LIMIT = {}\n"
                            "MAX_VELOCITY = {}\n"
                            "MAX_ACCELERATION = {}\n\n",
                            axis.letter, short_text(axis.min), short_text(axis.max), short_text(axis.speed),
                            short_text(axis.acceleration));
        for (const Motor &motor : axis.motors) {
            text += joint_text(plan, axis, motor, joint++);
        }
    }
    text.pop_back();
    return text;
}

}  // namespace mw::setup

// SPDX-License-Identifier: GPL-2.0-or-later
// Maximum speed and acceleration of a motor: both are increased until steps are lost, or until a servo does
// not follow. Lost steps are detected at the home switch, whose position is known.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/text.hh"
#include "machine/commissioning/steps.hh"

namespace mw::commissioning {
namespace {

/// Fraction of the maximum values without a fault that is used, because motors lose torque when they are warm
/// and loaded.
constexpr double SPEED_PART = 0.7, ACCELERATION_PART = 0.5;
/// Values of the trials: from a fraction of the answered value, increased by a factor, up to a multiple of
/// it.
constexpr double FIRST = 0.7, FACTOR = 1.4, MOST = 4;
/// Length of a trial.
constexpr double PART_OF_TRAVEL = 0.35;
/// New limits are active in the controller after this time [s].
constexpr double LIMITS_S = 0.05;

struct Limits {
    double speed = 0, acceleration = 0;
};

struct Trial {
    Fault fault = Fault::NONE;  ///< fault after which the session cannot continue
    bool isGood = false;
};

void set_limits(Stage &stage, int joint, const Limits &limits) {
    Bench &bench = stage.bench();
    bench.set_value(fmt::format("ini.{}.max_velocity", joint), limits.speed);
    bench.set_value(fmt::format("ini.{}.max_acceleration", joint), limits.acceleration);
    if (stage.plan().is_servo) {
        return;
    }
    const std::string generator = stage.plan().board == setup::Board::PARPORT
                                      ? fmt::format("stepgen.{}", joint)
                                      : fmt::format("hm2_7i76e.0.stepgen.{:02d}", stage.motor(joint).channel);
    constexpr double CATCH_UP = 1.05, CATCH_UP_ACCELERATION = 1.25;
    bench.set_value(generator + ".maxvel", limits.speed * CATCH_UP);
    bench.set_value(generator + ".maxaccel", limits.acceleration * CATCH_UP_ACCELERATION);
}

/// The maximum speed for which the board can make steps.
double most_speed(const Stage &stage, int joint) {
    const setup::Axis &axis = stage.axis(joint);
    // The speed must be reached within a trial.
    const double reached = std::sqrt(axis.acceleration * (axis.max - axis.min) * PART_OF_TRAVEL * 0.9);
    const double answered = std::min(axis.speed * MOST, reached);
    const setup::Motor &motor = stage.motor(joint);
    if (stage.plan().is_servo) {
        return std::min(answered, std::abs(motor.servo.full_speed) * 0.9);
    }
    if (!stage.plan().hasBaseThread()) {
        return answered;
    }
    constexpr double NS_PER_S = 1e9, MARGIN = 1.06;
    const double rate = NS_PER_S / (2.0 * stage.plan().wiring.base_period_ns);
    return std::min(answered, rate / (std::abs(motor.steps_per_unit) * MARGIN));
}

Prompt hold(const Stage &stage, int joint, const std::string &text) {
    Prompt prompt =
        make_prompt("limits", stage.motor(joint).name, text, "The motor: release the button when it stalls.");
    prompt.hazards = {"The axis moves fast while the button is pressed."};
    return prompt;
}

Prompt fast_prompt(const Stage &stage, int joint, const Limits &limits) {
    return hold(stage, joint,
                fmt::format("Hold the button: {} moves at {:.4g} {}/s with {:.4g} {}/s2.",
                            to_upper(stage.motor(joint).name), limits.speed, stage.unit(joint),
                            limits.acceleration, stage.unit(joint)));
}

/// One fast move in one direction; the other moves are slow. Fast moves in both directions would lose as many
/// steps in each direction, and the home switch would not detect them. A motor that stalls in one of the
/// moves and follows the others still ends inside the travel.
Flow<Trial> try_direction(Stage &stage, int joint, Limits limits, bool isForth, double &home_counts) {
    const setup::Axis axis = stage.axis(joint);
    const std::string pid = "pid-" + stage.motor(joint).name;
    const Limits slow{axis.speed * FIRST, axis.acceleration * FIRST};
    const double distance = (axis.max - axis.min) * PART_OF_TRAVEL * (axis.home_at_max ? -1 : 1);
    const double to_middle = (axis.max + axis.min) / 2 - stage.bench().joint(joint).command;
    const bool is_servo = stage.plan().is_servo;
    bool is_saturated = false;
    const Watch watch = [&](const JointReading &) {
        is_saturated = is_saturated || (is_servo && stage.bench().value(pid + ".saturated").value_or(1) != 0);
    };
    for (int leg = 0; leg < 3; ++leg) {
        const bool is_fast = leg == (isForth ? 1 : 2);
        const Limits now = is_fast ? limits : slow;
        set_limits(stage, joint, now);
        co_await stage.wait(LIMITS_S);
        Prompt prompt = fast_prompt(stage, joint, now);
        const double way = leg == 0 ? to_middle : leg == 1 ? distance : -distance;
        const std::vector<Motion> motions{{way, now.speed}};
        const Ending ending = co_await stage.move_while_held(joint, motions, std::move(prompt), watch);
        if (ending == Ending::STOPPED && is_servo && stage.bench().joint(joint).isFollowingErrorTripped) {
            co_return Trial{Fault::NONE, false};
        }
        if (ending != Ending::DONE) {
            co_return Trial{fault_of(ending), false};
        }
    }
    set_limits(stage, joint, slow);
    const Fault homed = co_await home_while_held(stage, joint);
    if (homed != Fault::NONE) {
        co_return Trial{homed, false};
    }
    const std::optional<double> counts = co_await counts_at_home(stage, joint);
    if (!counts.has_value()) {
        co_return Trial{Fault::STOPPED, false};
    }
    const double lost = std::abs(*counts - home_counts);
    home_counts = *counts;
    constexpr double ALLOWED = 2;
    co_return Trial{Fault::NONE, lost <= ALLOWED && !is_saturated};
}

Flow<Trial> try_limits(Stage &stage, int joint, Limits limits, double &home_counts) {
    Trial trial = co_await try_direction(stage, joint, limits, true, home_counts);
    if (trial.fault == Fault::NONE && trial.isGood) {
        trial = co_await try_direction(stage, joint, limits, false, home_counts);
    }
    co_return trial;
}

/// Switches on, and homes at the answered speed.
Flow<Fault> enable_and_home(Stage &stage, int joint, double &home_counts) {
    const Fault off =
        co_await stage.enable(joint, "limits",
                              fmt::format("Only the drive of {} is switched on. The axis homes, "
                                          "then moves faster and faster, without a tool.",
                                          to_upper(stage.motor(joint).name)));
    if (off != Fault::NONE) {
        co_return off;
    }
    const setup::Axis axis = stage.axis(joint);
    set_limits(stage, joint, {axis.speed * FIRST, axis.acceleration * FIRST});
    const Fault homed = co_await home_while_held(stage, joint);
    if (homed != Fault::NONE) {
        co_return homed;
    }
    const std::optional<double> counts = co_await counts_at_home(stage, joint);
    home_counts = counts.value_or(0);
    co_return counts.has_value() ? Fault::NONE : Fault::STOPPED;
}

struct Raised {
    Fault fault = Fault::NONE;
    double greatest = 0;  ///< maximum without a stall; 0: the first trial stalled
};

/// Increases speed or acceleration until a trial fails.
Flow<Raised> raise(Stage &stage, int joint, Limits limits, double Limits::*what, double most,
                   double &home_counts) {
    Raised raised;
    for (double value = std::min(limits.*what * FIRST, most);; value = std::min(value * FACTOR, most)) {
        limits.*what = value;
        const Trial trial = co_await try_limits(stage, joint, limits, home_counts);
        if (trial.fault != Fault::NONE) {
            raised.fault = trial.fault;
            co_return raised;
        }
        if (!trial.isGood) {
            co_return raised;
        }
        raised.greatest = value;
        if (value >= most) {
            co_return raised;
        }
    }
}

std::string rounded(double value) {
    constexpr double DIGITS = 10;
    return to_text(std::floor(value * DIGITS) / DIGITS);
}

}  // namespace

Flow<Finding> tune_limits(Stage &stage, int joint) {
    if (stage.plan().switches == setup::Switches::NONE || stage.axis(joint).motors.size() > 1) {
        co_return found("limits", stage, joint, Fault::NONE,
                        "speeds from the answers: only a home switch can detect lost steps");
    }
    const setup::Axis axis = stage.axis(joint);
    const std::string motor = stage.motor(joint).name;
    Raised speed, acceleration;
    double home_counts = 0;
    speed.fault = co_await enable_and_home(stage, joint, home_counts);
    if (speed.fault == Fault::NONE) {
        speed = co_await raise(stage, joint, {axis.speed, axis.acceleration}, &Limits::speed,
                               most_speed(stage, joint), home_counts);
    }
    // A servo that did not follow is off.
    if (speed.fault == Fault::NONE && !stage.bench().isOn()) {
        speed.fault = co_await enable_and_home(stage, joint, home_counts);
    }
    if (speed.fault == Fault::NONE && speed.greatest > 0) {
        acceleration = co_await raise(stage, joint, {speed.greatest * SPEED_PART, axis.acceleration},
                                      &Limits::acceleration, axis.acceleration * MOST, home_counts);
    }
    stage.bench().switch_off();
    const Fault fault = speed.fault != Fault::NONE ? speed.fault : acceleration.fault;
    if (fault != Fault::NONE || speed.greatest == 0 || acceleration.greatest == 0) {
        co_return found("limits", stage, joint, fault != Fault::NONE ? fault : Fault::STALLED);
    }
    Finding finding = found("limits", stage, joint, Fault::NONE);
    finding.values = {
        {"maximum speed without a stall", speed.greatest, std::string(stage.unit(joint)) + "/s"},
        {"maximum acceleration without a stall", acceleration.greatest,
         std::string(stage.unit(joint)) + "/s2"}};
    stage.change({{motor + ".speed", rounded(speed.greatest * SPEED_PART)},
                  {motor + ".acceleration", rounded(acceleration.greatest * ACCELERATION_PART)}});
    co_await stage.restart();
    co_return finding;
}

}  // namespace mw::commissioning

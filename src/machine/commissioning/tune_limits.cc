// SPDX-License-Identifier: GPL-2.0-or-later
// Maximum speed and acceleration of a motor: both are raised until steps are lost, or until a servo no longer
// follows. Lost steps show at the home switch, whose position is known.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/text.hh"
#include "machine/commissioning/steps.hh"

namespace mw::commissioning {
namespace {

/// Of the greatest values without a fault, this part is kept: motors lose torque when they are warm and
/// loaded.
constexpr double SPEED_PART = 0.7, ACCELERATION_PART = 0.5;
/// Trials: from a part of the answered value, by a factor, up to a multiple of it.
constexpr double FIRST = 0.7, FACTOR = 1.4, MOST = 4;
/// Length of a trial.
constexpr double PART_OF_TRAVEL = 0.35;

struct Limits {
    double speed = 0, acceleration = 0;
};

struct Trial {
    Fault fault = Fault::NONE;  ///< the session cannot continue
    bool isGood = false;
};

void set_limits(Stage &stage, int joint, const Limits &limits) {
    Bench &bench = stage.bench();
    bench.set_value(fmt::format("ini.{}.max_velocity", joint), limits.speed);
    bench.set_value(fmt::format("ini.{}.max_acceleration", joint), limits.acceleration);
    const std::string generator = stage.plan().board == setup::Board::PARPORT
                                      ? fmt::format("stepgen.{}", joint)
                                      : fmt::format("hm2_7i76e.0.stepgen.{:02d}", stage.motor(joint).channel);
    constexpr double CATCH_UP = 1.05, CATCH_UP_ACCELERATION = 1.25;
    bench.set_value(generator + ".maxvel", limits.speed * CATCH_UP);
    bench.set_value(generator + ".maxaccel", limits.acceleration * CATCH_UP_ACCELERATION);
}

/// The maximum speed for which steps can be made.
double most_speed(const Stage &stage, int joint) {
    const setup::Axis &axis = stage.axis(joint);
    // It must be reached within a trial.
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

Flow<Ending> move(Stage &stage, int joint, const Motion &motion, double acceleration) {
    Prompt prompt = make_prompt("limits", stage.motor(joint).name,
                                fmt::format("Hold the button: {} moves at {:.4g} {}/s with {:.4g} {}/s2.",
                                            to_upper(stage.motor(joint).name), motion.speed,
                                            stage.unit(joint), acceleration, stage.unit(joint)),
                                "The motor: release the button when it stalls.");
    prompt.hazards = {"The axis moves fast while the button is pressed."};
    const Ending ending = co_await stage.move_while_held(joint, motion, std::move(prompt));
    co_return ending;
}

/// Once forth and back from the middle of the travel: a motor that stalls in one of the two moves, and
/// follows the other, still ends inside the travel.
Flow<Trial> try_limits(Stage &stage, int joint, Limits limits, double &home_counts) {
    const setup::Axis axis = stage.axis(joint);
    const Limits slow{axis.speed * FIRST, axis.acceleration * FIRST};
    const double distance = (axis.max - axis.min) * PART_OF_TRAVEL * (axis.home_at_max ? -1 : 1);
    const double middle = (axis.max + axis.min) / 2;
    const std::string pid = "pid-" + stage.motor(joint).name;
    bool saturated = false;
    for (int leg = 0; leg < 3; ++leg) {
        const Limits &now = leg == 0 ? slow : limits;
        set_limits(stage, joint, now);
        co_await stage.wait(0.05);
        const double way = leg == 0   ? middle - stage.bench().joint(joint).command
                           : leg == 1 ? distance
                                      : -distance;
        const Ending ending = co_await move(stage, joint, {way, now.speed}, now.acceleration);
        if (ending == Ending::STOPPED && stage.plan().is_servo) {
            co_return Trial{Fault::NONE, false};
        }
        if (ending != Ending::DONE) {
            co_return Trial{ending == Ending::STOPPED ? Fault::STOPPED : Fault::GIVEN_UP, false};
        }
        saturated = saturated || stage.bench().value(pid + ".saturated").value_or(0) != 0;
    }
    set_limits(stage, joint, slow);
    const Fault homed = co_await home_while_held(stage, joint);
    if (homed != Fault::NONE) {
        co_return Trial{homed, false};
    }
    const double counts = co_await counts_at_home(stage, joint);
    const double lost = std::abs(counts - home_counts);
    home_counts = counts;
    constexpr double ALLOWED = 2;
    co_return Trial{Fault::NONE, lost <= ALLOWED && !saturated};
}

struct Raised {
    Fault fault = Fault::NONE;
    double greatest = 0;  ///< without a stall; 0: even the first one stalled
};

/// Raises one of the two until a trial fails.
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
                        "speeds as answered: lost steps show at a home switch only");
    }
    const setup::Axis axis = stage.axis(joint);
    const std::string motor = stage.motor(joint).name;
    const bool on = co_await stage.enable(joint, "limits",
                                          fmt::format("The drive of {} alone is switched on. The axis homes, "
                                                      "then moves faster and faster, without a tool.",
                                                      to_upper(motor)));
    if (!on) {
        co_return found("limits", stage, joint, Fault::GIVEN_UP, stage.bench().last_error());
    }
    Raised speed, acceleration;
    speed.fault = co_await home_while_held(stage, joint);
    if (speed.fault == Fault::NONE) {
        double home_counts = co_await counts_at_home(stage, joint);
        speed = co_await raise(stage, joint, {axis.speed, axis.acceleration}, &Limits::speed,
                               most_speed(stage, joint), home_counts);
        const Limits limits{speed.greatest * SPEED_PART, axis.acceleration};
        if (speed.fault == Fault::NONE && speed.greatest > 0) {
            acceleration = co_await raise(stage, joint, limits, &Limits::acceleration,
                                          axis.acceleration * MOST, home_counts);
        }
    }
    const std::string error = stage.bench().last_error();
    stage.bench().switch_off();
    const Fault fault = speed.fault != Fault::NONE ? speed.fault : acceleration.fault;
    if (fault != Fault::NONE || speed.greatest == 0 || acceleration.greatest == 0) {
        co_return found("limits", stage, joint, fault != Fault::NONE ? fault : Fault::STALLED, error);
    }
    Finding finding = found("limits", stage, joint, Fault::NONE);
    finding.values = {
        {"greatest speed without a stall", speed.greatest, std::string(stage.unit(joint)) + "/s"},
        {"greatest acceleration without a stall", acceleration.greatest,
         std::string(stage.unit(joint)) + "/s2"}};
    stage.change(motor + ".speed", rounded(speed.greatest * SPEED_PART));
    stage.change(motor + ".acceleration", rounded(acceleration.greatest * ACCELERATION_PART));
    co_await stage.restart();
    co_return finding;
}

}  // namespace mw::commissioning

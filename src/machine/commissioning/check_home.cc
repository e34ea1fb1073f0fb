// SPDX-License-Identifier: GPL-2.0-or-later
// Steps of a homed joint: its home switch, and how far it can travel.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/text.hh"
#include "machine/commissioning/steps.hh"

namespace mw::commissioning {
namespace {

/// Homing may move a joint by a part more than its travel, and to and fro at the switch.
constexpr double TRAVEL_FACTOR = 1.3, CLEARANCE_MM = 20;
/// A position that changes by more than the maximum speed in this time was set [s].
constexpr double JUMP_S = 0.01;

/// Where the board counts the joint.
std::string counts_name(const Stage &stage, int joint) {
    const setup::Motor &motor = stage.motor(joint);
    switch (stage.plan().board) {
    case setup::Board::MESA_7I76E: return fmt::format("hm2_7i76e.0.stepgen.{:02d}.counts", motor.channel);
    case setup::Board::MESA_7I97: return fmt::format("hm2_7i97.0.encoder.{:02d}.rawcounts", motor.channel);
    default: return fmt::format("stepgen.{}.counts", joint);
    }
}

Prompt hold(const char *step, const Stage &stage, int joint, const std::string &text, const char *watch) {
    Prompt prompt = make_prompt(step, stage.motor(joint).name, text, watch);
    prompt.ask = Ask::HOLD;
    prompt.hazards = {"The motor moves while the button is pressed. It stops when the button is released."};
    return prompt;
}

Flow<> settle(Stage &stage, int joint) {
    constexpr double SETTLE_S = 0.3;
    while (stage.bench().joint(joint).isMoving) {
        co_await stage.next_cycle();
    }
    co_await stage.wait(SETTLE_S);
}

}  // namespace

Flow<Fault> home_while_held(Stage &stage, int joint) {
    const setup::Axis &axis = stage.axis(joint);
    const double farthest = (axis.max - axis.min) * TRAVEL_FACTOR + stage.plan().small(axis, CLEARANCE_MM);
    // Homing sets the position at the switch: such a jump is no motion.
    const double most_step = axis.speed * JUMP_S;
    double last = stage.bench().joint(joint).feedback, travelled = 0;
    stage.show(
        hold("home", stage, joint,
             fmt::format("Hold the button: {} moves slowly to its home switch at the {} end, and homes.",
                         to_upper(stage.motor(joint).name), axis.home_at_max ? "positive" : "negative"),
             "The table: release the button when it passes the switch."));
    bool homing = false;
    while (true) {
        const JointReading reading = stage.bench().joint(joint);
        if (!stage.bench().isOn()) {
            co_return Fault::STOPPED;
        }
        if (homing && reading.isHomed && !reading.isHoming && !reading.isMoving) {
            co_return Fault::NONE;
        }
        const double step = std::abs(reading.feedback - last);
        last = reading.feedback;
        travelled += step < most_step ? step : 0;
        const bool is_too_far = travelled > farthest;
        if (is_too_far || stage.isGivenUp()) {
            stage.bench().stop(joint);
            co_return is_too_far ? Fault::SWITCH_NOT_REACHED : Fault::GIVEN_UP;
        }
        if (!homing && stage.isHeld()) {
            stage.bench().home(joint);
            homing = true;
            constexpr double REACTION_S = 0.05;
            co_await stage.wait(REACTION_S);
        } else if (homing && !stage.isHeld()) {
            stage.bench().stop(joint);
            homing = false;
        }
        co_await stage.next_cycle();
    }
}

Flow<double> counts_at_home(Stage &stage, int joint) {
    co_await settle(stage, joint);
    // A servo at standstill moves between neighbouring counts.
    constexpr int SAMPLES = 200;
    double sum = 0;
    for (int i = 0; i < SAMPLES; ++i) {
        sum += stage.bench().value(counts_name(stage, joint)).value_or(0);
        co_await stage.next_cycle();
    }
    const double counts = sum / SAMPLES;
    stage.bench().unhome(joint);
    constexpr double REACTION_S = 0.1;
    co_await stage.wait(REACTION_S);
    co_return counts;
}

Flow<Finding> check_home(Stage &stage, int joint) {
    if (stage.plan().switches == setup::Switches::NONE) {
        co_return found("home", stage, joint, Fault::NONE, "no switch");
    }
    if (stage.joints_of_axis(joint).front() != joint) {
        co_return found("home", stage, joint, Fault::NONE, "homed together with the other motor of the axis");
    }
    const std::string name = to_upper(stage.motor(joint).name);
    const bool on = co_await stage.enable_axis(
        joint, "home",
        fmt::format("The drive of {} is switched on. It will move to its home switch.{}", name,
                    stage.isOneOfTwo(joint) ? " Couple both motors to the axis: they home together." : ""));
    if (!on) {
        co_return found("home", stage, joint, Fault::GIVEN_UP, stage.bench().last_error());
    }
    constexpr int TIMES = 4;
    double least = 0, most = 0;
    Finding finding = found("home", stage, joint, Fault::NONE);
    for (int i = 0; i < TIMES && finding.fault == Fault::NONE; ++i) {
        finding.fault = co_await home_while_held(stage, joint);
        if (finding.fault != Fault::NONE) {
            finding.detail = stage.bench().last_error();
            break;
        }
        const double counts = co_await counts_at_home(stage, joint);
        least = i == 0 ? counts : std::min(least, counts);
        most = i == 0 ? counts : std::max(most, counts);
    }
    stage.bench().switch_off();
    constexpr double ALLOWED = 1;
    if (finding.fault == Fault::NONE && most - least > ALLOWED) {
        finding.fault = Fault::SWITCH_NOT_REPEATABLE;
    }
    finding.values.push_back({"spread of homing", most - least, "counts"});
    co_return finding;
}

Flow<Finding> check_travel(Stage &stage, int joint) {
    if (stage.plan().switches == setup::Switches::NONE || stage.isOneOfTwo(joint)) {
        co_return found("travel", stage, joint, Fault::NONE, "travel as answered");
    }
    const setup::Axis axis = stage.axis(joint);
    const std::string motor = stage.motor(joint).name, name = to_upper(motor);
    const bool on = co_await stage.enable(
        joint, "travel",
        fmt::format("The drive of {} alone is switched on. It homes, then moves to its other end.", name));
    if (!on) {
        co_return found("travel", stage, joint, Fault::GIVEN_UP, stage.bench().last_error());
    }
    const Fault homed = co_await home_while_held(stage, joint);
    if (homed != Fault::NONE) {
        co_return found("travel", stage, joint, homed, stage.bench().last_error());
    }
    co_await settle(stage, joint);
    stage.bench().unhome(joint);
    co_await stage.wait(0.1);
    const double sign = axis.home_at_max ? -1 : 1;
    const double start = stage.bench().joint(joint).command;
    const double limit = axis.home_at_max ? axis.min : axis.max;
    // Ends of travel are looked for at a speed at which the axis stops within a fraction of a millimetre.
    const double speed = std::min(axis.speed / 4, stage.plan().small(axis, 8));
    Prompt prompt = hold(
        "travel", stage, joint,
        fmt::format("Hold the button: {} moves to its other end. Release it before the end of travel, then "
                    "confirm.",
                    name),
        "The table: it must not reach the end stop.");
    const double farthest = std::abs(limit - start) * TRAVEL_FACTOR;
    const Ending ending = co_await stage.move_while_held(joint, {sign * farthest, speed}, std::move(prompt));
    const double reached = stage.bench().joint(joint).command;
    if (ending == Ending::STOPPED || ending == Ending::CANNOT) {
        stage.bench().switch_off();
        co_return found("travel", stage, joint, ending == Ending::STOPPED ? Fault::STOPPED : Fault::GIVEN_UP,
                        stage.bench().last_error());
    }
    // Back to the middle, so that the next steps have clearance.
    Prompt back = hold("travel", stage, joint,
                       fmt::format("Hold the button: {} moves back to the middle.", name), "The table.");
    static_cast<void>(co_await stage.move_while_held(joint, {(start - reached) / 2, speed}, std::move(back)));
    stage.bench().switch_off();
    Finding finding = found("travel", stage, joint, Fault::NONE);
    const double rounded = sign > 0 ? std::floor(reached * 10) / 10 : std::ceil(reached * 10) / 10;
    finding.values.push_back({axis.home_at_max ? "lower limit" : "upper limit", rounded, stage.unit(joint)});
    stage.change(motor + (axis.home_at_max ? ".min" : ".max"), to_text(rounded));
    co_await stage.restart();
    co_return finding;
}

}  // namespace mw::commissioning

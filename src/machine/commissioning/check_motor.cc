// SPDX-License-Identifier: GPL-2.0-or-later
// Steps of one motor: direction, scale and backlash.
#include <cmath>

#include <fmt/format.h>

#include "base/text.hh"
#include "machine/commissioning/steps.hh"

namespace mw::commissioning {
namespace {

constexpr const char *FREE =
    "The axis must be free to move: in the middle of its travel, tool and work removed.";

Prompt hold(const char *step, const Stage &stage, int joint, const std::string &text) {
    Prompt prompt =
        make_prompt(step, stage.motor(joint).name, text, "The table: release the button before an end.");
    prompt.hazards = {"The motor moves while the button is pressed. It stops when the button is released."};
    return prompt;
}

std::string toggled(const std::string &answer) {
    return answer == "yes" ? "no" : "yes";
}

void reverse_motor(Stage &stage, int joint) {
    const std::string name = stage.motor(joint).name;
    if (stage.plan().is_servo) {
        stage.change(name + ".reverse_output", toggled(stage.answer(name + ".reverse_output")));
    } else if (stage.answer(name + ".transmission") == "travel") {
        stage.change(name + ".way_per_turn", to_text(-stage.number(name + ".way_per_turn")));
    } else {
        stage.change(name + ".reverse", toggled(stage.answer(name + ".reverse")));
    }
}

/// Sets the output to the commanded speed without feedback, so that a wrong sign of the encoder cannot cause
/// a runaway.
void open_loop(Stage &stage, int joint) {
    const std::string pid = "pid-" + stage.motor(joint).name;
    for (const char *gain : {".Pgain", ".Igain", ".Dgain", ".FF2"}) {
        stage.bench().set_value(pid + gain, 0);
    }
    stage.bench().set_value(pid + ".FF1", 1);
}

struct Seen {
    Fault fault = Fault::NONE;
    std::string way;  ///< "positive", "negative", "not at all"
    double commanded = 0, counted = 0;
};

/// Moves a short distance in the positive direction and asks which direction the operator saw.
Flow<Seen> look_at_direction(Stage &stage, int joint) {
    const setup::Axis &axis = stage.axis(joint);
    const double distance = stage.plan().small(axis, stage.plan().is_servo ? 0.7 : 3);
    const JointReading before = stage.bench().joint(joint);
    Prompt prompt =
        hold("direction", stage, joint,
             fmt::format("Hold the button: the motor moves {} about {} {} in the positive direction.",
                         to_upper(stage.motor(joint).name), to_text(distance), stage.unit(joint)));
    const Ending ending =
        co_await stage.move_while_held(joint, Motion{distance, stage.slow(joint) / 2}, std::move(prompt));
    const JointReading after = stage.bench().joint(joint);
    Seen seen{.fault = fault_of(ending),
              .way = "",
              .commanded = after.command - before.command,
              .counted = after.feedback - before.feedback};
    if (seen.fault != Fault::NONE) {
        co_return seen;
    }
    Prompt question =
        make_prompt("direction", stage.motor(joint).name,
                    fmt::format("In which direction did the tool of {} move relative to the work?",
                                to_upper(stage.motor(joint).name)),
                    "Positive: X to the right, Y away from you, Z up, as the tool sees the work.");
    question.choices = {"positive", "negative", "not at all"};
    seen.way = co_await stage.choose(std::move(question));
    seen.fault = seen.way.empty() ? Fault::GIVEN_UP : Fault::NONE;
    co_return seen;
}

/// Checks whether the encoder counts while the table moves.
Fault judge_encoder(const Seen &seen) {
    const double part = seen.counted / seen.commanded;
    constexpr double LEAST = 0.1;
    if (std::abs(part) < LEAST) {
        return seen.way == "not at all" ? Fault::MOTOR_NOT_CONNECTED : Fault::ENCODER_NOT_CONNECTED;
    }
    const bool counts_up = part > 0;
    return counts_up == (seen.way == "positive") ? Fault::NONE : Fault::ENCODER_PHASES_SWAPPED;
}

/// Asks whether the encoder may be reversed in the configuration; false: it will be rewired.
Flow<bool> may_reverse_encoder(Stage &stage, int joint) {
    Prompt question = make_prompt(
        "direction", stage.motor(joint).name,
        fmt::format(
            "The encoder of {} counts against the motion. Reverse it in the controller, or swap its wires?",
            to_upper(stage.motor(joint).name)));
    question.choices = {"reverse", "wires"};
    const std::string chosen = co_await stage.choose(std::move(question));
    co_return chosen == "reverse";
}

}  // namespace

Flow<Finding> check_direction(Stage &stage, int joint) {
    constexpr int ROUNDS = 3;
    const std::string name = to_upper(stage.motor(joint).name);
    for (int round = 0; round < ROUNDS; ++round) {
        const Fault off = co_await stage.enable(
            joint, "direction", fmt::format("Only the drive of {} is switched on. {}", name, FREE));
        if (off != Fault::NONE) {
            co_return found("direction", stage, joint, off);
        }
        if (stage.plan().is_servo) {
            open_loop(stage, joint);
        }
        const Seen seen = co_await look_at_direction(stage, joint);
        stage.bench().switch_off();
        if (seen.fault != Fault::NONE) {
            co_return found("direction", stage, joint, seen.fault);
        }
        const Fault encoder = stage.plan().is_servo ? judge_encoder(seen) : Fault::NONE;
        if (seen.way == "not at all" || encoder == Fault::ENCODER_NOT_CONNECTED ||
            encoder == Fault::MOTOR_NOT_CONNECTED) {
            co_return found("direction", stage, joint,
                            encoder == Fault::NONE ? Fault::MOTOR_NOT_CONNECTED : encoder);
        }
        if (encoder == Fault::ENCODER_PHASES_SWAPPED) {
            const bool reversed = co_await may_reverse_encoder(stage, joint);
            if (!reversed) {
                co_return found("direction", stage, joint, encoder);
            }
            const std::string key = stage.motor(joint).name + ".reverse_encoder";
            stage.change(key, toggled(stage.answer(key)));
        }
        if (seen.way == "negative") {
            reverse_motor(stage, joint);
        } else if (encoder == Fault::NONE) {
            co_await stage.restart();
            co_return found("direction", stage, joint, Fault::NONE, round == 0 ? "" : "reversed");
        }
        co_await stage.restart();
    }
    co_return found("direction", stage, joint, Fault::MOTOR_NOT_CONNECTED, "the direction is not constant");
}

namespace {

struct Measured {
    Fault fault = Fault::NONE;
    double commanded = 0, measured = 0;
};

/// Takes up the play, asks the operator to zero a gauge, moves, and asks for the measured travel.
Flow<Measured> measure_travel(Stage &stage, int joint, double distance) {
    const double speed = stage.slow(joint);
    const std::string name = to_upper(stage.motor(joint).name);
    const double run_up = stage.plan().small(stage.axis(joint), 2);
    Prompt to_start =
        hold("scale", stage, joint, fmt::format("Hold the button: {} moves to the start.", name));
    const std::vector<Motion> approach{{-(distance / 2 + run_up), speed}, {run_up, speed}};
    const Ending started = co_await stage.move_while_held(joint, approach, std::move(to_start));
    if (started != Ending::DONE) {
        co_return Measured{fault_of(started), 0, 0};
    }
    Prompt zero =
        make_prompt("scale", stage.motor(joint).name,
                    fmt::format("Set the gauge on {} to zero: a ruler for short, a caliper or indicator for "
                                "exact measurements.",
                                name));
    const bool zeroed = co_await stage.confirm(std::move(zero));
    if (!zeroed) {
        co_return Measured{Fault::GIVEN_UP, 0, 0};
    }
    Prompt prompt =
        hold("scale", stage, joint,
             fmt::format("Hold the button: {} moves by {} {}.", name, to_text(distance), stage.unit(joint)));
    const Ending ending = co_await stage.move_while_held(joint, Motion{distance, speed}, std::move(prompt));
    if (ending != Ending::DONE) {
        co_return Measured{fault_of(ending), 0, 0};
    }
    Prompt read = make_prompt("scale", stage.motor(joint).name, fmt::format("Read the gauge on {}.", name));
    read.unit = stage.unit(joint);
    const std::optional<double> value = co_await stage.measure(std::move(read));
    if (!value.has_value()) {
        co_return Measured{Fault::GIVEN_UP, 0, 0};
    }
    // Moves back to the middle, because the next steps rely on the clearance there.
    Prompt back = hold("scale", stage, joint, fmt::format("Hold the button: {} moves back.", name));
    const Ending centred =
        co_await stage.move_while_held(joint, Motion{-distance / 2, speed}, std::move(back));
    co_return Measured{fault_of(centred), distance, *value};
}

/// Travel of each round; short while the scale may be very wrong.
double distance_of_round(const Stage &stage, int joint, int round) {
    const setup::Axis &axis = stage.axis(joint);
    const double travel = axis.max - axis.min;
    const double longest = stage.plan().small(axis, axis.isRotary() ? 90 : 100);
    constexpr double PART = 0.5;
    return round == 0 ? std::min(stage.plan().small(axis, 4), travel * 0.05)
                      : std::min(longest, travel * PART);
}

}  // namespace

Flow<Finding> check_scale(Stage &stage, int joint) {
    constexpr int ROUNDS = 4;
    constexpr double CONFIRMED_PART = 0.0006, MOST_FACTOR = 50;
    const std::string key = stage.motor(joint).name + ".correction";
    Finding finding = found("scale", stage, joint, Fault::SCALE);
    for (int round = 0; round < ROUNDS; ++round) {
        const Fault off = co_await stage.enable(
            joint, "scale",
            fmt::format("Only the drive of {} is switched on. {}", to_upper(stage.motor(joint).name), FREE));
        if (off != Fault::NONE) {
            finding.fault = off;
            co_return finding;
        }
        const Measured measured =
            co_await measure_travel(stage, joint, distance_of_round(stage, joint, round));
        stage.bench().switch_off();
        if (measured.fault != Fault::NONE) {
            finding.fault = measured.fault;
            co_return finding;
        }
        const double factor = measured.commanded / measured.measured;
        if (!(factor > 1 / MOST_FACTOR && factor < MOST_FACTOR)) {
            finding.detail = fmt::format("{} commanded, {} measured", to_text(measured.commanded),
                                         to_text(measured.measured));
            co_return finding;
        }
        if (round > 0 && std::abs(factor - 1) < CONFIRMED_PART) {
            finding.fault = Fault::NONE;
            finding.values.push_back(
                {"measured for the last distance", measured.measured, stage.unit(joint)});
            finding.values.push_back({"correction", stage.number(key), ""});
            co_await stage.restart();
            co_return finding;
        }
        constexpr double DIGITS = 1e7;
        stage.change(key, to_text(std::round(stage.number(key) * factor * DIGITS) / DIGITS));
        co_await stage.restart();
    }
    co_return finding;
}

namespace {

// Texts are selected outside of coroutines, because GCC 12 destroys temporaries of a conditional expression
// in a coroutine twice.
Prompt backlash_prompt(const Stage &stage, int joint, bool isBack) {
    const std::string name = to_upper(stage.motor(joint).name);
    return hold("backlash", stage, joint,
                isBack ? fmt::format("Hold the button: {} moves back.", name)
                       : fmt::format("Hold the button: {} moves forward.", name));
}

}  // namespace

Flow<Finding> measure_backlash(Stage &stage, int joint) {
    if (stage.isOneOfTwo(joint)) {
        co_return found("backlash", stage, joint, Fault::NONE, "two motors: backlash from the answers");
    }
    const std::string motor = stage.motor(joint).name, name = to_upper(motor);
    const double travel = stage.plan().small(stage.axis(joint), 2), speed = stage.slow(joint);
    const Fault off = co_await stage.enable(
        joint, "backlash", fmt::format("Only the drive of {} is switched on. {}", name, FREE));
    if (off != Fault::NONE) {
        co_return found("backlash", stage, joint, off);
    }
    // Moves to the position, farther, and back to it. The backlash is the difference between the two
    // approaches.
    Ending ending = Ending::DONE;
    double reading = 0;
    for (int leg = 0; leg < 3 && ending == Ending::DONE; ++leg) {
        Prompt prompt = backlash_prompt(stage, joint, leg == 2);
        ending = co_await stage.move_while_held(joint, Motion{leg == 2 ? -travel : travel, speed},
                                                std::move(prompt));
        if (leg == 0 && ending == Ending::DONE) {
            Prompt zero =
                make_prompt("backlash", motor, fmt::format("Set the indicator on {} to zero.", name));
            const bool zeroed = co_await stage.confirm(std::move(zero));
            ending = zeroed ? ending : Ending::CANNOT;
        }
    }
    if (ending == Ending::DONE) {
        Prompt read = make_prompt("backlash", motor, fmt::format("Read the indicator on {}.", name));
        read.unit = stage.unit(joint);
        const std::optional<double> value = co_await stage.measure(std::move(read));
        ending = value.has_value() ? ending : Ending::CANNOT;
        reading = value.value_or(0);
    }
    stage.bench().switch_off();
    if (ending != Ending::DONE) {
        co_return found("backlash", stage, joint, fault_of(ending));
    }
    const double before = stage.motor(joint).backlash;
    const double least = stage.plan().small(stage.axis(joint), 0.01);
    const double backlash = std::max(0.0, before + reading);
    if (std::abs(reading) >= least) {
        stage.change(motor + ".backlash", to_text(std::round(backlash * 1e4) / 1e4));
        co_await stage.restart();
    }
    Finding finding = found("backlash", stage, joint, Fault::NONE);
    finding.values.push_back({"backlash", backlash, stage.unit(joint)});
    co_return finding;
}

}  // namespace mw::commissioning

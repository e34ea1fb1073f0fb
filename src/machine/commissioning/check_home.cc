// SPDX-License-Identifier: GPL-2.0-or-later
// Steps for a homed joint: its home switch, and its travel.
#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "base/text.hh"
#include "machine/commissioning/steps.hh"

namespace mw::commissioning {
namespace {

/// Maximum distance of homing relative to the travel of the joint; homing may also move to and fro at the
/// switch.
constexpr double TRAVEL_FACTOR = 1.3, CLEARANCE_MM = 20;
/// A position that changes by more than the maximum speed in this time was set, not moved [s].
constexpr double JUMP_S = 0.01;
/// A home request is visible in the state of the machine within REACTION_S; a stop has ended within the other
/// time [s].
constexpr double REACTION_S = 0.2, STOPPING_S = 3;

/// Name of the pin with the counts of the board for the joint.
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

// Texts are selected outside of coroutines, because GCC 12 destroys temporaries of a conditional expression
// in a coroutine twice.
Prompt home_prompt(const Stage &stage, int joint) {
    const std::string name = to_upper(stage.motor(joint).name);
    const std::string text =
        stage.axis(joint).home_at_max
            ? fmt::format(
                  "Hold the button: {} moves slowly to its home switch at the positive end, and homes.", name)
            : fmt::format(
                  "Hold the button: {} moves slowly to its home switch at the negative end, and homes.",
                  name);
    return hold("home", stage, joint, text, "The table: release the button when it passes the switch.");
}

std::string enable_text(const Stage &stage, int joint) {
    return stage.isOneOfTwo(joint)
               ? fmt::format(
                     "Couple both motors to the axis. The drives of {} are switched on. They will move "
                     "together to the home switches.",
                     stage.axis(joint).letter)
               : fmt::format("The drive of {} is switched on. It will move to its home switch.",
                             to_upper(stage.motor(joint).name));
}

/// Distance that a joint has moved. Homing sets the position at the switch; such a jump is not motion.
class Travel {
  public:
    Travel(double start, double most_step) : last_(start), most_step_(most_step) {}
    void add(double position) {
        const double step = std::abs(position - std::exchange(last_, position));
        sum_ += step < most_step_ ? step : 0;
    }
    double sum() const { return sum_; }

  private:
    double last_, most_step_, sum_ = 0;
};

}  // namespace

Flow<Fault> home_while_held(Stage &stage, int joint) {
    const setup::Axis &axis = stage.axis(joint);
    const double farthest = (axis.max - axis.min) * TRAVEL_FACTOR + stage.plan().small(axis, CLEARANCE_MM);
    Travel travel(stage.bench().joint(joint).feedback, axis.speed * JUMP_S);
    stage.show(home_prompt(stage, joint));
    bool is_requested = false, has_begun = false;
    double since_s = stage.bench().now_s();
    while (stage.bench().isOn()) {
        const JointReading reading = stage.bench().joint(joint);
        const double waited_s = stage.bench().now_s() - since_s;
        const bool is_active = reading.isMoving || reading.isHoming;
        has_begun = is_requested && (has_begun || reading.isHoming);
        travel.add(reading.feedback);
        if (has_begun && reading.isHomed && !is_active) {
            const bool is_settled = co_await stage.settle(joint);
            co_return is_settled ? Fault::NONE : Fault::STOPPED;
        }
        if (is_requested && (!stage.isHeld() || stage.isGivenUp() || travel.sum() > farthest)) {
            stage.bench().stop(joint);
            is_requested = false;
            since_s = stage.bench().now_s();
        } else if (is_requested && !is_active && waited_s > REACTION_S) {
            stage.switch_off_because("Homing ended early.");
        } else if (!is_requested && is_active && waited_s > STOPPING_S) {
            stage.switch_off_because("The axis does not stop.");
        } else if (!is_requested && !is_active && (stage.isGivenUp() || travel.sum() > farthest)) {
            co_return stage.isGivenUp() ? Fault::GIVEN_UP : Fault::SWITCH_NOT_REACHED;
        } else if (!is_requested && !is_active && stage.isHeld()) {
            stage.bench().home(joint);
            is_requested = true;
            since_s = stage.bench().now_s();
        }
        co_await stage.next_cycle();
    }
    co_return Fault::STOPPED;
}

Flow<std::optional<double>> counts_at_home(Stage &stage, int joint) {
    // Averages samples, because a servo at standstill moves between neighbouring counts.
    constexpr int SAMPLES = 200;
    std::optional<double> sum = 0;
    for (int i = 0; i < SAMPLES && sum.has_value(); ++i) {
        const std::optional<double> counts = stage.bench().value(counts_name(stage, joint));
        sum = counts.has_value() ? std::optional(*sum + *counts) : std::nullopt;
        co_await stage.next_cycle();
    }
    if (!sum.has_value()) {
        stage.switch_off_because("The board has no pin " + counts_name(stage, joint) + ".");
        co_return std::nullopt;
    }
    stage.bench().unhome(joint);
    constexpr double UNHOMING_S = 0.1;
    co_await stage.wait(UNHOMING_S);
    // The sum of whole counts is exact.
    co_return *sum / SAMPLES;
}

Flow<Finding> check_home(Stage &stage, int joint) {
    if (stage.plan().switches == setup::Switches::NONE) {
        co_return found("home", stage, joint, Fault::NONE, "no switch");
    }
    if (stage.joints_of_axis(joint).front() != joint) {
        co_return found("home", stage, joint, Fault::NONE, "homed together with the other motor of the axis");
    }
    const Fault off = co_await stage.enable_axis(joint, "home", enable_text(stage, joint));
    if (off != Fault::NONE) {
        co_return found("home", stage, joint, off);
    }
    constexpr int TIMES = 4;
    double least = 0, most = 0;
    Finding finding = found("home", stage, joint, Fault::NONE);
    for (int i = 0; i < TIMES && finding.fault == Fault::NONE; ++i) {
        finding.fault = co_await home_while_held(stage, joint);
        if (finding.fault != Fault::NONE) {
            co_return finding;
        }
        const std::optional<double> counts = co_await counts_at_home(stage, joint);
        if (!counts.has_value()) {
            co_return found("home", stage, joint, Fault::STOPPED);
        }
        least = i == 0 ? *counts : std::min(least, *counts);
        most = i == 0 ? *counts : std::max(most, *counts);
    }
    constexpr double ALLOWED = 1, ROUNDING = 1e-6;
    if (finding.fault == Fault::NONE && most - least > ALLOWED + ROUNDING) {
        finding.fault = Fault::SWITCH_NOT_REPEATABLE;
    }
    finding.values.push_back({"spread of homing", most - least, "counts"});
    co_return finding;
}

Flow<Finding> check_travel(Stage &stage, int joint) {
    if (stage.plan().switches == setup::Switches::NONE || stage.isOneOfTwo(joint)) {
        co_return found("travel", stage, joint, Fault::NONE, "travel from the answers");
    }
    const setup::Axis axis = stage.axis(joint);
    const std::string motor = stage.motor(joint).name, name = to_upper(motor);
    const Fault off = co_await stage.enable(
        joint, "travel",
        fmt::format("Only the drive of {} is switched on. It homes, then moves to its other end.", name));
    if (off != Fault::NONE) {
        co_return found("travel", stage, joint, off);
    }
    const Fault homed = co_await home_while_held(stage, joint);
    if (homed != Fault::NONE) {
        co_return found("travel", stage, joint, homed);
    }
    stage.bench().unhome(joint);
    co_await stage.wait(0.1);
    const double sign = axis.home_at_max ? -1 : 1;
    const double start = stage.bench().joint(joint).command;
    const double limit = axis.home_at_max ? axis.min : axis.max;
    // The search for the ends of travel uses a speed at which the axis stops within a fraction of a
    // millimetre.
    const double speed = std::min(axis.speed / 4, stage.plan().small(axis, 8));
    Prompt prompt = hold(
        "travel", stage, joint,
        fmt::format("Hold the button: {} moves to its other end. Release it before the end of travel, then "
                    "confirm.",
                    name),
        "The table: it must not reach the end stop.");
    prompt.may_end_early = true;
    const double farthest = std::abs(limit - start) * TRAVEL_FACTOR;
    const Ending ending =
        co_await stage.move_while_held(joint, Motion{sign * farthest, speed}, std::move(prompt));
    if (fault_of(ending) != Fault::NONE) {
        co_return found("travel", stage, joint, fault_of(ending));
    }
    const double reached = stage.bench().joint(joint).command;
    // Moves back to the middle, because the next steps rely on the clearance there.
    Prompt back = hold("travel", stage, joint,
                       fmt::format("Hold the button: {} moves back to the middle.", name), "The table.");
    const Ending centred =
        co_await stage.move_while_held(joint, Motion{(start - reached) / 2, speed}, std::move(back));
    if (fault_of(centred) != Fault::NONE) {
        co_return found("travel", stage, joint, fault_of(centred));
    }
    Finding finding = found("travel", stage, joint, Fault::NONE);
    const double rounded = sign > 0 ? std::floor(reached * 10) / 10 : std::ceil(reached * 10) / 10;
    finding.values.push_back({axis.home_at_max ? "lower limit" : "upper limit", rounded, stage.unit(joint)});
    stage.change(motor + (axis.home_at_max ? ".min" : ".max"), to_text(rounded));
    co_await stage.restart();
    co_return finding;
}

}  // namespace mw::commissioning

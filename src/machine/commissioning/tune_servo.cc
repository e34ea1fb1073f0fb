// SPDX-License-Identifier: GPL-2.0-or-later
// The position controller of a servo: the speed at 10 V, then its gains from a relay test (Astrom and
// Hagglund 1984), compared by the following error of the same moves before and after tuning.
#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "base/text.hh"
#include "machine/commissioning/steps.hh"

namespace mw::commissioning {
namespace {

constexpr const char *WATCH = "The table: release the button before an end, or when the motor howls.";

Prompt hold(const Stage &stage, int joint, const std::string &text) {
    Prompt prompt = make_prompt("tune", stage.motor(joint).name, text, WATCH);
    prompt.ask = Ask::HOLD;
    prompt.hazards = {"The motor moves fast, and may oscillate, while the button is pressed."};
    return prompt;
}

std::string pid_of(const Stage &stage, int joint) {
    return "pid-" + stage.motor(joint).name;
}

struct Followed {
    Ending ending = Ending::DONE;
    double greatest = 0;  ///< maximum following error [units]
    double lag_s = 0;     ///< mean error at constant speed, divided by the speed [s]
};

/// Moves to and fro at a fraction of the maximum speed, and measures the following error.
Flow<Followed> follow(Stage &stage, int joint, double part) {
    const setup::Axis &axis = stage.axis(joint);
    const double speed = axis.speed * part;
    const double distance = std::min((axis.max - axis.min) * 0.2, speed * 1.0);
    Followed followed;
    double sum = 0, last = stage.bench().joint(joint).command, last_s = stage.bench().now_s();
    int samples = 0;
    const Watch watch = [&](const JointReading &reading) {
        const double error = stage.bench().value(pid_of(stage, joint) + ".error").value_or(0);
        followed.greatest = std::max(followed.greatest, std::abs(error));
        const double now_s = stage.bench().now_s();
        const double velocity = now_s > last_s ? (reading.command - last) / (now_s - last_s) : 0;
        if (std::abs(std::abs(velocity) - speed) < speed * 0.01) {
            sum += error / velocity;
            ++samples;
        }
        last = reading.command;
        last_s = now_s;
    };
    Prompt prompt = hold(stage, joint,
                         fmt::format("Hold the button: {} moves forth and back at {} {}/s.",
                                     to_upper(stage.motor(joint).name), to_text(speed), stage.unit(joint)));
    const std::vector<Motion> twice_forth_and_back{
        {distance, speed}, {-distance, speed}, {distance, speed}, {-distance, speed}};
    followed.ending = co_await stage.move_while_held(joint, twice_forth_and_back, std::move(prompt), watch);
    followed.lag_s = samples > 0 ? sum / samples : 0;
    co_return followed;
}

struct Relay {
    Ending ending = Ending::DONE;
    double ultimate_gain = 0, ultimate_period_s = 0;
};

/// Replaces the controller with a relay until the loop has oscillated for some periods.
Flow<Relay> run_relay(Stage &stage, int joint) {
    const setup::Axis &axis = stage.axis(joint);
    const std::string pid = pid_of(stage, joint);
    Relay relay;
    stage.show(hold(stage, joint,
                    fmt::format("Hold the button: {} oscillates a little around its position.",
                                to_upper(stage.motor(joint).name))));
    Bench &bench = stage.bench();
    while (bench.isOn() && !stage.isHeld() && !stage.isGivenUp()) {
        co_await stage.next_cycle();
    }
    if (!bench.isOn() || stage.isGivenUp()) {
        relay.ending = bench.isOn() ? Ending::CANNOT : Ending::STOPPED;
        co_return relay;
    }
    bench.set_value(pid + ".tune-type", 0);
    bench.set_value(pid + ".tune-cycles", 40);
    bench.set_value(pid + ".tune-effort", std::min(axis.speed * 0.2, stage.plan().small(axis, 10)));
    bench.set_value(pid + ".tune-mode", 1);
    bench.set_value(pid + ".tune-start", 1);
    constexpr double PATIENCE_S = 20, FARTHEST_MM = 10;
    const double end_s = bench.now_s() + PATIENCE_S, start = bench.joint(joint).feedback;
    co_await stage.wait(0.01);
    while (bench.value(pid + ".tune-start").value_or(0) != 0) {
        if (std::abs(bench.joint(joint).feedback - start) > stage.plan().small(axis, FARTHEST_MM)) {
            stage.switch_off_because("The axis moved too far during the relay test.");
            relay.ending = Ending::STOPPED;
            break;
        }
        const bool over = bench.now_s() > end_s;
        if (!bench.isOn() || !stage.isHeld() || over) {
            relay.ending = bench.isOn() ? Ending::CANNOT : Ending::STOPPED;
            break;
        }
        co_await stage.next_cycle();
    }
    bench.set_value(pid + ".tune-start", 0);
    bench.set_value(pid + ".tune-mode", 0);
    // The rules of Ziegler and Nichols, inverted: P = 0.6 Ku, D = P Tu / 8.
    const double p = bench.value(pid + ".Pgain").value_or(0), d = bench.value(pid + ".Dgain").value_or(0);
    relay.ultimate_gain = p / 0.6;
    relay.ultimate_period_s = p > 0 ? 8 * d / p : 0;
    for (const char *gain : {".Igain", ".Dgain"}) {
        bench.set_value(pid + gain, 0);
    }
    bench.set_value(pid + ".Pgain", stage.motor(joint).servo.p);
    co_return relay;
}

/// Minimum gain margin of the chosen proportional gain.
constexpr double GAIN_MARGIN = 3.5;
/// Proportional gain times the sum of lag and delay of the loop, for a phase margin of about 60 degrees.
constexpr double GAIN_BY_LAG = 0.5, DELAY_S = 0.002;

struct Gains {
    double p = 0, ff2 = 0;
};

/// For a drive that follows a speed command with a first-order lag: at the ultimate frequency w its gain is 1
/// / (w sqrt(1 + (w t)^2)) = 1 / Ku. Without a lag only the sampling of the loop limits the gain.
Gains gains_of(const Relay &relay) {
    const double w = 2 * std::numbers::pi / relay.ultimate_period_s;
    const double ratio = relay.ultimate_gain / w;
    const double lag_s = ratio > 1 ? std::sqrt(ratio * ratio - 1) / w : 0;
    return {std::min(relay.ultimate_gain / GAIN_MARGIN, GAIN_BY_LAG / (lag_s + DELAY_S)), lag_s};
}

double rounded(double value, double digits) {
    return std::round(value * digits) / digits;
}

}  // namespace

Flow<Finding> tune_servo(Stage &stage, int joint) {
    Finding finding = found("tune", stage, joint, Fault::NOT_TUNED);
    if (!stage.plan().is_servo) {
        finding.fault = Fault::NONE;
        finding.detail = "no control loop";
        co_return finding;
    }
    const std::string motor = stage.motor(joint).name, name = to_upper(motor);
    constexpr double PART = 0.5;
    const Fault off = co_await stage.enable(
        joint, "tune",
        fmt::format("Only the drive of {} is switched on. The axis must be in the middle of its travel.",
                    name));
    if (off != Fault::NONE) {
        finding.fault = off;
        co_return finding;
    }
    const Followed before = co_await follow(stage, joint, PART);
    Relay relay;
    relay.ending = before.ending;
    if (before.ending == Ending::DONE) {
        relay = co_await run_relay(stage, joint);
    }
    stage.bench().switch_off();
    if (relay.ending != Ending::DONE || !(relay.ultimate_period_s > 0)) {
        finding.fault = relay.ending == Ending::DONE ? Fault::NOT_TUNED : fault_of(relay.ending);
        co_return finding;
    }
    // At constant speed v the output is v FF1 + P e, and the drive runs at v. This gives its real speed at 10
    // V.
    const setup::Servo &servo = stage.motor(joint).servo;
    const double drive_gain = 1 / (servo.ff1 + servo.p * before.lag_s);
    relay.ultimate_gain *= drive_gain;
    const Gains gains = gains_of(relay);
    stage.change(
        {{motor + ".full_speed", to_text(rounded(stage.number(motor + ".full_speed") * drive_gain, 1e5))},
         {motor + ".p", to_text(rounded(gains.p, 100))},
         {motor + ".ff1", "1"},
         {motor + ".ff2", to_text(rounded(gains.ff2, 1e6))}});
    co_await stage.restart();
    const Fault off_again = co_await stage.enable(
        joint, "tune", fmt::format("Only the drive of {} is switched on with its new gains.", name));
    if (off_again != Fault::NONE) {
        finding.fault = off_again;
        co_return finding;
    }
    const Followed after = co_await follow(stage, joint, PART);
    finding.values = {{"following error before", before.greatest, stage.unit(joint)},
                      {"following error after", after.greatest, stage.unit(joint)},
                      {"ultimate gain", relay.ultimate_gain, "1/s"},
                      {"ultimate period", relay.ultimate_period_s, "s"},
                      {"proportional gain", gains.p, "1/s"},
                      {"acceleration feed-forward", gains.ff2, "s"}};
    if (after.ending != Ending::DONE) {
        finding.fault = fault_of(after.ending);
    } else if (after.greatest < before.greatest / 2) {
        finding.fault = Fault::NONE;
    }
    co_return finding;
}

}  // namespace mw::commissioning

// SPDX-License-Identifier: GPL-2.0-or-later
// The spindle: its speed against a tachometer.
#include <cmath>

#include <fmt/format.h>

#include "base/text.hh"
#include "machine/commissioning/steps.hh"

namespace mw::commissioning {
namespace {

struct Turned {
    Fault fault = Fault::NONE;
    double measured = 0;
};

Flow<Turned> turn(Stage &stage, double speed_rpm) {
    const Fault off =
        co_await stage.enable(Bench::NO_JOINT, "spindle",
                              "Remove the tool and close the guard. The machine is switched on without the "
                              "drives of its axes.");
    if (off != Fault::NONE) {
        co_return Turned{off, 0};
    }
    Prompt start = make_prompt(
        "spindle", "",
        fmt::format("The spindle turns at {} rev/min as soon as you confirm.", to_text(speed_rpm)));
    start.hazards = {"The spindle turns.", "Keep away from chuck, collet and belt."};
    const bool started = co_await stage.confirm(std::move(start));
    if (!started) {
        stage.bench().switch_off();
        co_return Turned{Fault::GIVEN_UP, 0};
    }
    stage.bench().run_spindle(speed_rpm);
    constexpr double RUN_UP_S = 5;
    co_await stage.wait(RUN_UP_S);
    Prompt read = make_prompt("spindle", "", "Read the tachometer.");
    read.unit = "rev/min";
    // Maximum time for entering a measurement; after it the spindle stops.
    constexpr double PATIENCE_S = 120;
    const std::optional<double> value = co_await stage.measure(std::move(read), PATIENCE_S);
    const bool was_on = stage.bench().isOn();
    stage.bench().stop_spindle();
    co_await stage.wait(1);
    stage.bench().switch_off();
    if (!was_on) {
        co_return Turned{Fault::STOPPED, 0};
    }
    co_return Turned{value.has_value() ? Fault::NONE : Fault::GIVEN_UP, value.value_or(0)};
}

}  // namespace

Flow<Finding> check_spindle(Stage &stage, int joint) {
    if (stage.plan().wiring.spindle.full_output == 0) {
        co_return found("spindle", stage, joint, Fault::NONE, "no speed output to measure");
    }
    constexpr int ROUNDS = 4;
    constexpr double PART = 0.5, CONFIRMED_PART = 0.005, MOST_FACTOR = 20;
    Finding finding = found("spindle", stage, joint, Fault::SPINDLE);
    for (int round = 0; round < ROUNDS; ++round) {
        const double speed = std::round(stage.plan().spindle_max * PART);
        const Turned turned = co_await turn(stage, speed);
        if (turned.fault != Fault::NONE) {
            finding.fault = turned.fault;
            co_return finding;
        }
        const double factor = turned.measured / speed;
        if (std::abs(factor - 1) < CONFIRMED_PART) {
            finding.fault = Fault::NONE;
            finding.values.push_back({"commanded", speed, "rev/min"});
            finding.values.push_back({"measured", turned.measured, "rev/min"});
            co_return finding;
        }
        if (!(factor > 1 / MOST_FACTOR && factor < MOST_FACTOR)) {
            finding.detail =
                fmt::format("{} commanded, {} measured", to_text(speed), to_text(turned.measured));
            co_return finding;
        }
        const double full = stage.number("spindle.full_output") * factor;
        stage.change("spindle.full_output", to_text(std::round(full * 10) / 10));
        co_await stage.restart();
    }
    co_return finding;
}

}  // namespace mw::commissioning

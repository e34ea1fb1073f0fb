// SPDX-License-Identifier: GPL-2.0-or-later
// Steps without motion: the thread, the switches, the emergency stop and the probe.
#include <algorithm>

#include <fmt/format.h>

#include "base/text.hh"
#include "machine/commissioning/steps.hh"

namespace mw::commissioning {
namespace {

constexpr double WATCH_S = 2, PATIENCE_S = 60, SETTLE_S = 0.1;

Prompt by_hand(const char *step, std::string motor, std::string text) {
    Prompt prompt = make_prompt(step, std::move(motor), std::move(text), "The state of the input.");
    prompt.ask = Ask::ACTION;
    prompt.hazards = {"The drives are off. Keep them off."};
    return prompt;
}

/// The inputs that the step compares.
std::vector<bool> levels(Stage &stage) {
    std::vector<bool> all;
    for (int joint = 0; joint < stage.plan().joints(); ++joint) {
        all.push_back(stage.bench().joint(joint).isHomeSwitchOn);
    }
    all.push_back(stage.bench().isProbeOn());
    return all;
}

/// Number of inputs that change although the operator touches nothing.
Flow<int> count_changes(Stage &stage, double seconds) {
    auto last = levels(stage);
    int changes = 0;
    const double end_s = stage.bench().now_s() + seconds;
    while (stage.bench().now_s() < end_s) {
        co_await stage.next_cycle();
        auto now = levels(stage);
        for (std::size_t i = 0; i < now.size(); ++i) {
            changes += now[i] != last[i] ? 1 : 0;
        }
        last = std::move(now);
    }
    co_return changes;
}

/// The first input that differs from `rest`; -1 after the timeout, or if the operator cannot operate one.
Flow<int> wait_for_change(Stage &stage, std::vector<bool> rest) {
    const double end_s = stage.bench().now_s() + PATIENCE_S;
    while (stage.bench().now_s() < end_s && !stage.isGivenUp()) {
        const auto now = levels(stage);
        for (std::size_t i = 0; i < now.size(); ++i) {
            if (now[i] != rest[i]) {
                co_return static_cast<int>(i);
            }
        }
        co_await stage.next_cycle();
    }
    co_return -1;
}

Flow<> wait_for_rest(Stage &stage, std::vector<bool> rest) {
    const double end_s = stage.bench().now_s() + PATIENCE_S;
    while (stage.bench().now_s() < end_s && !stage.isGivenUp() && levels(stage) != rest) {
        co_await stage.next_cycle();
    }
    co_await stage.wait(SETTLE_S);
}

/// Inverts the contact of a switch.
void turn_contact(Stage &stage, int joint) {
    const std::string key = stage.motor(joint).name + ".home_contact";
    stage.change(key, stage.motor(joint).home_contact_closed ? "open" : "closed");
}

struct Pressed {
    Fault fault = Fault::NONE;
    int at = -1;  ///< the input that changed
};

Flow<Pressed> press_switch(Stage &stage, int joint) {
    const std::string name = to_upper(stage.motor(joint).name);
    const auto rest = levels(stage);
    stage.show(by_hand("inputs", stage.motor(joint).name,
                       fmt::format("Press the home switch of {} and keep it pressed.", name)));
    const int at = co_await wait_for_change(stage, rest);
    if (at < 0) {
        co_return Pressed{Fault::SWITCH_NOT_CONNECTED, at};
    }
    co_await stage.wait(SETTLE_S);
    stage.show(
        by_hand("inputs", stage.motor(joint).name, fmt::format("Release the home switch of {}.", name)));
    co_await wait_for_rest(stage, rest);
    co_return Pressed{at == joint ? Fault::NONE : Fault::SWITCH_AT_OTHER_INPUT, at};
}

}  // namespace

Finding found(const char *step, const Stage &stage, int joint, Fault fault, std::string detail) {
    return {.step = step,
            .motor = joint >= 0 ? stage.motor(joint).name : "",
            .fault = fault,
            .detail = std::move(detail),
            .values = {},
            .before = {},
            .after = {}};
}

Flow<Finding> check_thread(Stage &stage, int joint) {
    stage.show(make_prompt(
        "thread", "", "The computer is monitored. Use it as in normal operation: screen, network, files.",
        "Late cycles of the servo thread: there must be none."));
    constexpr double THREAD_S = 5;
    const std::uint64_t before = stage.bench().late_cycles();
    co_await stage.wait(THREAD_S);
    const auto late = static_cast<double>(stage.bench().late_cycles() - before);
    Finding finding = found("thread", stage, joint, late > 0 ? Fault::LATE_THREAD : Fault::NONE);
    finding.values.push_back({"late cycles", late, ""});
    constexpr double US_PER_S = 1e6;
    finding.values.push_back({"latest wake-up", stage.bench().worst_latency_s() * US_PER_S, "us"});
    finding.values.push_back({"watched", THREAD_S, "s"});
    co_return finding;
}

Flow<Finding> check_inputs(Stage &stage, int joint) {
    Prompt free = by_hand(
        "inputs", "",
        "Move every axis to the middle of its travel by hand or by its screw. No switch may be touched.");
    const bool clear = co_await stage.confirm(std::move(free));
    if (!clear) {
        co_return found("inputs", stage, joint, Fault::GIVEN_UP);
    }
    stage.show(make_prompt("inputs", "", "The inputs are monitored. Do not touch anything."));
    const int changes = co_await count_changes(stage, WATCH_S);
    if (changes > 0) {
        co_return found("inputs", stage, joint, Fault::NOISE,
                        fmt::format("{} changes in {} s", changes, WATCH_S));
    }
    const auto rest = levels(stage);
    bool changed = false;
    for (int one = 0; one < stage.plan().joints(); ++one) {
        if (!stage.motor(one).home_pin.has_value()) {
            continue;
        }
        const Pressed pressed = co_await press_switch(stage, one);
        if (pressed.fault != Fault::NONE) {
            const bool is_motor = pressed.at >= 0 && pressed.at < stage.plan().joints();
            co_return found("inputs", stage, one, pressed.fault,
                            is_motor ? "the input of " + to_upper(stage.motor(pressed.at).name) + " changed"
                                     : "");
        }
        if (rest[static_cast<std::size_t>(one)]) {
            turn_contact(stage, one);
            changed = true;
        }
    }
    Finding finding = found("inputs", stage, joint, Fault::NONE);
    if (changed) {
        co_await stage.restart();
        for (int one = 0; one < stage.plan().joints(); ++one) {
            if (stage.bench().joint(one).isHomeSwitchOn) {
                finding = found("inputs", stage, one, Fault::SWITCH_NOT_CONNECTED, "actuated at rest");
            }
        }
    }
    co_return finding;
}

Flow<Finding> check_estop(Stage &stage, int joint) {
    if (!stage.plan().wiring.estop_pin.has_value()) {
        co_return found("estop", stage, joint, Fault::NONE, "no input; the button on the screen is used");
    }
    Prompt free = by_hand("estop", "", "Release all emergency stop buttons.");
    const bool released = co_await stage.confirm(std::move(free));
    if (!released) {
        co_return found("estop", stage, joint, Fault::GIVEN_UP);
    }
    const bool rest = stage.bench().isEstopReleased();
    stage.show(by_hand("estop", "", "Press the emergency stop button."));
    const double end_s = stage.bench().now_s() + PATIENCE_S;
    while (stage.bench().isEstopReleased() == rest && stage.bench().now_s() < end_s && !stage.isGivenUp()) {
        co_await stage.next_cycle();
    }
    if (stage.bench().isEstopReleased() == rest) {
        co_return found("estop", stage, joint, Fault::ESTOP_NOT_CONNECTED);
    }
    stage.show(by_hand("estop", "", "Release the emergency stop button."));
    const double last_s = stage.bench().now_s() + PATIENCE_S;
    while (stage.bench().isEstopReleased() != rest && stage.bench().now_s() < last_s && !stage.isGivenUp()) {
        co_await stage.next_cycle();
    }
    if (!rest) {
        co_return found("estop", stage, joint, Fault::ESTOP_NORMALLY_OPEN);
    }
    const Fault off =
        co_await stage.enable(Bench::NO_JOINT, "estop", "The machine is switched on without its drives.");
    if (off != Fault::NONE) {
        co_return found("estop", stage, joint, off);
    }
    stage.show(by_hand("estop", "", "Press the emergency stop button. The machine must switch off."));
    const double off_s = stage.bench().now_s() + PATIENCE_S;
    while (stage.bench().isOn() && stage.bench().now_s() < off_s && !stage.isGivenUp()) {
        co_await stage.next_cycle();
    }
    const bool works = !stage.bench().isOn();
    stage.bench().switch_off();
    stage.show(by_hand("estop", "", "Release the emergency stop button."));
    const double free_s = stage.bench().now_s() + PATIENCE_S;
    while (!stage.bench().isEstopReleased() && stage.bench().now_s() < free_s && !stage.isGivenUp()) {
        co_await stage.next_cycle();
    }
    co_return found("estop", stage, joint, works ? Fault::NONE : Fault::ESTOP_NOT_CONNECTED);
}

Flow<Finding> check_probe(Stage &stage, int joint) {
    if (!stage.plan().wiring.probe_pin.has_value()) {
        co_return found("probe", stage, joint, Fault::NONE, "no probe");
    }
    stage.show(make_prompt("probe", "", "The probe is monitored. Do not touch anything."));
    const int changes = co_await count_changes(stage, WATCH_S);
    if (changes > 0) {
        co_return found("probe", stage, joint, Fault::NOISE,
                        fmt::format("{} changes in {} s", changes, WATCH_S));
    }
    const auto rest = levels(stage);
    stage.show(by_hand("probe", "", "Touch the probe by hand and keep it touched."));
    const int at = co_await wait_for_change(stage, rest);
    stage.show(by_hand("probe", "", "Release the probe."));
    co_await wait_for_rest(stage, rest);
    if (at != stage.plan().joints()) {
        co_return found("probe", stage, joint, Fault::PROBE_NOT_CONNECTED);
    }
    if (rest.back()) {
        stage.change("probe.contacts", stage.plan().wiring.probe_contact_closed ? "open" : "closed");
        co_await stage.restart();
    }
    const bool wrong = stage.bench().isProbeOn();
    co_return found("probe", stage, joint, wrong ? Fault::PROBE_NOT_CONNECTED : Fault::NONE);
}

}  // namespace mw::commissioning

// SPDX-License-Identifier: GPL-2.0-or-later
#include "machine/commissioning/stage.hh"

#include <algorithm>
#include <cmath>

#include "base/text.hh"

namespace mw::commissioning {
namespace {

/// A button counts as released when its client has not renewed it for so long [s].
constexpr double HOLD_LEASE_S = 0.25;
constexpr double SWITCHING_TIMEOUT_S = 5;

/// A computer that cannot make the steps of a corrected scale at this speed moves the axis at a lower speed.
setup::Answers with_possible_speeds(setup::Answers answers) {
    constexpr double PART = 0.95, DIGITS = 1000;
    constexpr int MOST_TIMES = 100;
    for (int i = 0; i < MOST_TIMES; ++i) {
        const auto faults = setup::plan_of(answers).faults;
        if (faults.empty() || !std::ranges::all_of(faults, [](const setup::Fault &fault) {
                return fault.key.ends_with(".speed") || fault.key.ends_with(".home_speed");
            })) {
            return answers;
        }
        for (const setup::Fault &fault : faults) {
            const auto asked = setup::questions(answers);
            const double speed = parse_double(setup::answer_of(asked, answers, fault.key)).value_or(0);
            answers[fault.key] = to_text(std::floor(speed * PART * DIGITS) / DIGITS);
        }
    }
    return answers;
}

}  // namespace

Stage::Stage(setup::Answers answers) : answers_(std::move(answers)), plan_(setup::plan_of(answers_).plan) {}

void Stage::attach(Bench *bench) {
    bench_ = bench;
    held_until_s_ = -1;
    isRestartWanted_ = isRestartWanted_ && bench == nullptr;
}

void Stage::resume() {
    if (waiting_ && bench_ != nullptr) {
        std::exchange(waiting_, {}).resume();
    }
}

void Stage::drop() {
    waiting_ = {};
    if (bench_ == nullptr) {
        return;
    }
    for (int joint = 0; joint < plan_.joints(); ++joint) {
        bench_->stop(joint);
    }
    bench_->stop_spindle();
    bench_->switch_off();
}

bool Stage::act(int prompt_number, const Act &act) {
    if (prompt_number != prompt_number_ || bench_ == nullptr) {
        return false;
    }
    if (act.type == Act::Type::CANNOT) {
        act_ = act;
        return true;
    }
    if (act.type == Act::Type::HOLD) {
        held_until_s_ = bench_->now_s() + HOLD_LEASE_S;
        return prompt_.ask == Ask::HOLD;
    }
    const bool fits = act.type == Act::Type::CONFIRM ? prompt_.ask == Ask::CONFIRM || prompt_.ask == Ask::HOLD
                      : act.type == Act::Type::NUMBER
                          ? prompt_.ask == Ask::NUMBER && std::isfinite(act.number)
                          : prompt_.ask == Ask::CHOICE &&
                                std::ranges::find(prompt_.choices, act.choice) != prompt_.choices.end();
    if (fits) {
        act_ = act;
    }
    return fits;
}

std::string Stage::answer(std::string_view key) const {
    return setup::answer_of(setup::questions(answers_), answers_, key);
}

double Stage::number(std::string_view key) const {
    return parse_double(answer(key)).value_or(0);
}

const setup::Axis &Stage::axis(int joint) const {
    int left = joint;
    for (const setup::Axis &axis : plan_.axes) {
        if (left < static_cast<int>(axis.motors.size())) {
            return axis;
        }
        left -= static_cast<int>(axis.motors.size());
    }
    return plan_.axes.front();
}

const setup::Motor &Stage::motor(int joint) const {
    int left = joint;
    for (const setup::Axis &axis : plan_.axes) {
        if (left < static_cast<int>(axis.motors.size())) {
            return axis.motors[static_cast<std::size_t>(left)];
        }
        left -= static_cast<int>(axis.motors.size());
    }
    return plan_.axes.front().motors.front();
}

std::vector<int> Stage::joints_of_axis(int joint) const {
    const char letter = axis(joint).letter;
    std::vector<int> joints;
    for (int one = 0; one < plan_.joints(); ++one) {
        if (axis(one).letter == letter) {
            joints.push_back(one);
        }
    }
    return joints;
}

double Stage::slow(int joint) const {
    constexpr double SLOW_MM_S = 3, PART = 0.25;
    const setup::Axis &one = axis(joint);
    return std::min(plan_.small(one, SLOW_MM_S), one.speed * PART);
}

const char *Stage::unit(int joint) const {
    return axis(joint).isRotary() ? "deg" : plan_.metric ? "mm" : "in";
}

Flow<> Stage::wait(double seconds) {
    const double end_s = bench().now_s() + seconds;
    while (bench().now_s() < end_s) {
        co_await next_cycle();
    }
}

void Stage::show(Prompt prompt) {
    prompt_ = std::move(prompt);
    ++prompt_number_;
    act_.reset();
    held_until_s_ = -1;
}

Flow<bool> Stage::confirm(Prompt prompt) {
    prompt.ask = Ask::CONFIRM;
    show(std::move(prompt));
    while (!act_.has_value()) {
        co_await next_cycle();
    }
    const bool confirmed = isConfirmed();
    show(make_prompt(prompt_.step, prompt_.motor, ""));
    co_return confirmed;
}

Flow<std::optional<double>> Stage::measure(Prompt prompt) {
    prompt.ask = Ask::NUMBER;
    show(std::move(prompt));
    while (!act_.has_value()) {
        co_await next_cycle();
    }
    const std::optional<double> value =
        act_->type == Act::Type::NUMBER ? std::optional(act_->number) : std::nullopt;
    co_return value;
}

Flow<std::string> Stage::choose(Prompt prompt) {
    prompt.ask = Ask::CHOICE;
    show(std::move(prompt));
    while (!act_.has_value()) {
        co_await next_cycle();
    }
    const std::string chosen = act_->type == Act::Type::CHOICE ? act_->choice : "";
    co_return chosen;
}

bool Stage::isHeld() const {
    return bench_ != nullptr && bench_->now_s() < held_until_s_;
}

Flow<bool> Stage::enable_joints(std::vector<int> joints, Prompt prompt) {
    prompt.watch = "The emergency stop must be within reach.";
    const bool confirmed = co_await confirm(std::move(prompt));
    if (!confirmed) {
        co_return false;
    }
    bench().switch_on(joints);
    const double end_s = bench().now_s() + SWITCHING_TIMEOUT_S;
    while (!bench().isOn() && bench().now_s() < end_s) {
        co_await next_cycle();
    }
    co_return bench().isOn();
}

Flow<bool> Stage::enable(int joint, std::string step, std::string text) {
    Prompt prompt = make_prompt(std::move(step), joint >= 0 ? motor(joint).name : "", std::move(text));
    prompt.hazards = {"The motor may start unexpectedly.", "Keep hands and tools out of the machine."};
    if (joint >= 0 && isOneOfTwo(joint)) {
        prompt.hazards.emplace_back("Two motors move this axis. Uncouple this motor from the axis first: "
                                    "alone it would rack the gantry.");
    }
    return enable_joints(joint >= 0 ? std::vector<int>{joint} : std::vector<int>{}, std::move(prompt));
}

Flow<bool> Stage::enable_axis(int joint, std::string step, std::string text) {
    Prompt prompt = make_prompt(std::move(step), motor(joint).name, std::move(text));
    prompt.hazards = {"The motor may start unexpectedly.", "Keep hands and tools out of the machine."};
    return enable_joints(joints_of_axis(joint), std::move(prompt));
}

Flow<Ending> Stage::move_while_held(int joint, Motion motion, Prompt prompt) {
    prompt.ask = Ask::HOLD;
    show(std::move(prompt));
    const double start = bench().joint(joint).command;
    const double near = std::abs(motion.distance) * 1e-6 + 1e-9;
    bool moving = false;
    while (true) {
        const JointReading reading = bench().joint(joint);
        const double left = motion.distance - (reading.command - start);
        if (!bench().isOn()) {
            co_return Ending::STOPPED;
        }
        if (!reading.isMoving && std::abs(left) <= near) {
            co_return Ending::DONE;
        }
        if (moving && (!isHeld() || act_.has_value())) {
            bench().stop(joint);
            moving = false;
        } else if (!moving && !reading.isMoving && act_.has_value()) {
            co_return isConfirmed() ? Ending::CONFIRMED : Ending::CANNOT;
        } else if (!moving && !reading.isMoving && isHeld()) {
            bench().move(joint, left, motion.speed);
            moving = true;
            // The request takes some cycles to show.
            constexpr double REACTION_S = 0.05;
            co_await wait(REACTION_S);
        } else if (moving && !reading.isMoving) {
            moving = false;
        }
        co_await next_cycle();
    }
}

void Stage::change(const std::string &key, std::string value) {
    setup::Answers answers = answers_;
    answers[key] = std::move(value);
    answers = with_possible_speeds(std::move(answers));
    for (const auto &[changed, now] : answers) {
        if (answer(changed) != now || changed == key) {
            before_.try_emplace(changed, answer(changed));
        }
    }
    set_answers(std::move(answers));
}

void Stage::set_answers(setup::Answers answers) {
    const setup::Planned planned = setup::plan_of(answers);
    if (planned.faults.empty()) {
        answers_ = std::move(answers);
        plan_ = planned.plan;
    }
}

Flow<> Stage::restart() {
    bench().switch_off();
    constexpr double SETTLE_S = 0.2;
    co_await wait(SETTLE_S);
    isRestartWanted_ = true;
    // The machine's side attaches a new bench before the next cycle. Cards at a serial bus take their time.
    co_await next_cycle();
    constexpr double START_S = 1;
    co_await wait(START_S);
}

setup::Answers Stage::take_changes() {
    return std::exchange(before_, {});
}

}  // namespace mw::commissioning

// SPDX-License-Identifier: GPL-2.0-or-later
#include "machine/commissioning/current_answers.hh"

#include <algorithm>
#include <cmath>

#include "base/text.hh"

namespace mw::commissioning {
namespace {

/// If the computer cannot make the steps of a corrected scale at this speed, the axis speed is reduced.
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

CurrentAnswers::CurrentAnswers(setup::Answers answers)
    : answers_(std::move(answers)), plan_(setup::plan_of(answers_).plan) {}

std::string CurrentAnswers::answer(std::string_view key) const {
    return setup::answer_of(setup::questions(answers_), answers_, key);
}

double CurrentAnswers::number(std::string_view key) const {
    return parse_double(answer(key)).value_or(0);
}

const setup::Axis &CurrentAnswers::axis(int joint) const {
    int left = joint;
    for (const setup::Axis &axis : plan_.axes) {
        if (left < static_cast<int>(axis.motors.size())) {
            return axis;
        }
        left -= static_cast<int>(axis.motors.size());
    }
    return plan_.axes.front();
}

const setup::Motor &CurrentAnswers::motor(int joint) const {
    int left = joint;
    for (const setup::Axis &axis : plan_.axes) {
        if (left < static_cast<int>(axis.motors.size())) {
            return axis.motors[static_cast<std::size_t>(left)];
        }
        left -= static_cast<int>(axis.motors.size());
    }
    return plan_.axes.front().motors.front();
}

std::vector<int> CurrentAnswers::joints_of_axis(int joint) const {
    const char letter = axis(joint).letter;
    std::vector<int> joints;
    for (int one = 0; one < plan_.joints(); ++one) {
        if (axis(one).letter == letter) {
            joints.push_back(one);
        }
    }
    return joints;
}

double CurrentAnswers::slow(int joint) const {
    constexpr double SLOW_MM_S = 3, PART = 0.25;
    const setup::Axis &one = axis(joint);
    return std::min(plan_.small(one, SLOW_MM_S), one.speed * PART);
}

const char *CurrentAnswers::unit(int joint) const {
    return axis(joint).isRotary() ? "deg" : plan_.metric ? "mm" : "in";
}

void CurrentAnswers::change(const setup::Answers &changed) {
    setup::Answers answers = answers_;
    for (const auto &[key, value] : changed) {
        answers[key] = value;
    }
    answers = with_possible_speeds(std::move(answers));
    const setup::Planned planned = setup::plan_of(answers);
    if (!planned.faults.empty()) {
        rejected_ = planned.faults[0].key + ": " + planned.faults[0].text;
        return;
    }
    for (const auto &[key, now] : answers) {
        if (answer(key) != now || changed.contains(key)) {
            before_.try_emplace(key, answer(key));
        }
    }
    answers_ = std::move(answers);
    plan_ = planned.plan;
}

}  // namespace mw::commissioning

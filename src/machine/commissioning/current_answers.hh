// SPDX-License-Identifier: GPL-2.0-or-later
// The answers about the machine, as corrected by the steps, and the plan that follows from them.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "machine/setup/plan.hh"

namespace mw::commissioning {

/// Joints are counted from 0 in the order of the plan.
class CurrentAnswers {
  public:
    explicit CurrentAnswers(setup::Answers answers);

    const setup::Plan &plan() const { return plan_; }
    const setup::Answers &answers() const { return answers_; }
    std::string answer(std::string_view key) const;
    double number(std::string_view key) const;
    const setup::Axis &axis(int joint) const;
    const setup::Motor &motor(int joint) const;
    /// A speed that is slow for this axis [units/s].
    double slow(int joint) const;
    const char *unit(int joint) const;
    /// Joints of the axis of a joint.
    std::vector<int> joints_of_axis(int joint) const;
    /// True if the motor moves an axis together with another motor.
    bool isOneOfTwo(int joint) const { return axis(joint).motors.size() > 1; }

    /// Changes several answers together. A value that does not fit the other answers is not changed and
    /// becomes a fault of the step.
    void change(const setup::Answers &changed);
    void change(const std::string &key, std::string value) { change({{key, std::move(value)}}); }
    /// Answers that were changed since the last call, with their previous values.
    setup::Answers take_changes() { return std::exchange(before_, {}); }
    /// The reason why a change since the last call was not accepted; empty if all were accepted.
    std::string take_rejected() { return std::exchange(rejected_, {}); }

  private:
    setup::Answers answers_, before_;
    setup::Plan plan_;
    std::string rejected_;
};

}  // namespace mw::commissioning

// SPDX-License-Identifier: GPL-2.0-or-later
// What a step works with: the machine, the answers about it, and the operator.
#pragma once

#include <coroutine>
#include <optional>
#include <string>

#include "machine/commissioning/bench.hh"
#include "machine/commissioning/flow.hh"
#include "machine/commissioning/prompt.hh"
#include "machine/commissioning/record.hh"
#include "machine/setup/plan.hh"

namespace mw::commissioning {

/// How a motion under the operator's button has ended.
enum class Ending { DONE, CONFIRMED, CANNOT, STOPPED };

struct Motion {
    double distance = 0;
    double speed = 0;
};

/// One thread. Answers of the operator are valid for the current prompt only.
class Stage {
  public:
    explicit Stage(setup::Answers answers);

    // For the machine's side.
    /// The machine that runs with the current answers; null: it is being restarted.
    void attach(Bench *bench);
    bool isRestartWanted() const { return isRestartWanted_; }
    /// Resumes the step that waits for the next cycle.
    void resume();
    /// Nothing moves any more, and the step that waits will not be resumed.
    void drop();

    // For the operator's side.
    const Prompt &prompt() const { return prompt_; }
    int prompt_number() const { return prompt_number_; }
    /// False: it answers another prompt than the current one, or does not fit it.
    bool act(int prompt_number, const Act &act);

    // For steps.
    Bench &bench() { return *bench_; }
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
    /// It moves an axis together with another motor.
    bool isOneOfTwo(int joint) const { return axis(joint).motors.size() > 1; }

    struct NextCycle {
        Stage &stage;
        bool await_ready() const noexcept { return false; }
        void await_suspend(std::coroutine_handle<> handle) noexcept { stage.waiting_ = handle; }
        void await_resume() const noexcept {}
    };
    NextCycle next_cycle() { return {*this}; }
    Flow<> wait(double seconds);

    /// False: the operator cannot.
    Flow<bool> confirm(Prompt prompt);
    Flow<std::optional<double>> measure(Prompt prompt);
    /// Empty: the operator cannot say.
    Flow<std::string> choose(Prompt prompt);
    /// Shows a prompt while the step itself works or watches.
    void show(Prompt prompt);
    bool isHeld() const;
    /// The operator has confirmed, or cannot do, what is shown.
    bool isConfirmed() const { return act_.has_value() && act_->type == Act::Type::CONFIRM; }
    bool isGivenUp() const { return act_.has_value() && act_->type == Act::Type::CANNOT; }

    /// Switches the machine on with the drive of one joint, after the operator has confirmed. False: it is
    /// not on.
    Flow<bool> enable(int joint, std::string step, std::string text);
    /// The same with the drives of all motors of its axis.
    Flow<bool> enable_axis(int joint, std::string step, std::string text);
    /// Moves a joint by at most a distance, only while the button is pressed.
    Flow<Ending> move_while_held(int joint, Motion motion, Prompt prompt);

    void change(const std::string &key, std::string value);
    /// The machine runs with the changed answers after it.
    Flow<> restart();
    void want_restart() { isRestartWanted_ = true; }
    /// Answers that were changed since the last call, with their values before.
    setup::Answers take_changes();

  private:
    Flow<bool> enable_joints(std::vector<int> joints, Prompt prompt);
    void set_answers(setup::Answers answers);

    setup::Answers answers_, before_;
    setup::Plan plan_;
    Bench *bench_ = nullptr;
    bool isRestartWanted_ = false;
    std::coroutine_handle<> waiting_;
    Prompt prompt_;
    int prompt_number_ = 0;
    std::optional<Act> act_;
    double held_until_s_ = -1;
};

}  // namespace mw::commissioning

// SPDX-License-Identifier: GPL-2.0-or-later
// The objects that a step uses: the machine, the answers about it, and the operator.
#pragma once

#include <coroutine>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "machine/commissioning/bench.hh"
#include "machine/commissioning/current_answers.hh"
#include "machine/commissioning/flow.hh"
#include "machine/commissioning/prompt.hh"
#include "machine/commissioning/record.hh"

namespace mw::commissioning {

/// How a motion under the operator's button has ended. DONE: the distance is done and the axis is at
/// standstill. CONFIRMED: the operator has ended it early, if the prompt permits this. The other values: the
/// operator cannot do it, or the machine is off.
enum class Ending { DONE, CONFIRMED, CANNOT, STOPPED };
/// NONE if the step can continue after the motion.
Fault fault_of(Ending ending);

struct Motion {
    double distance = 0;
    double speed = 0;
};
/// Called in each cycle during a motion.
using Watch = std::function<void(const JointReading &)>;

/// All calls come from one thread. Answers of the operator are valid for the current prompt only.
class Stage : public CurrentAnswers {
  public:
    using CurrentAnswers::CurrentAnswers;

    // --- for the machine's side
    /// Sets the machine that runs with the current answers; null: it is being restarted.
    void attach(Bench *bench);
    bool isRestartWanted() const { return isRestartWanted_; }
    /// Resumes the step that waits for the next cycle.
    void resume();
    /// Ends the step: nothing moves, the machine is off, and the waiting step is not resumed.
    void drop();

    // --- for the operator's side
    const Prompt &prompt() const { return prompt_; }
    int prompt_number() const { return prompt_number_; }
    /// False if the action answers another prompt than the current one, or does not fit it.
    bool act(int prompt_number, const Act &act);

    // --- for steps
    Bench &bench() { return *bench_; }

    struct NextCycle {
        Stage &stage;
        bool await_ready() const noexcept { return false; }
        void await_suspend(std::coroutine_handle<> handle) noexcept { stage.waiting_ = handle; }
        void await_resume() const noexcept {}
    };
    NextCycle next_cycle() { return {*this}; }
    Flow<> wait(double seconds);

    /// False: the operator cannot do it.
    Flow<bool> confirm(Prompt prompt);
    /// Nothing: the operator cannot do it, or has not answered in time.
    Flow<std::optional<double>> measure(Prompt prompt, double patience_s = FOREVER_S);
    /// Empty: the operator does not know.
    Flow<std::string> choose(Prompt prompt);
    /// Shows a prompt while the step works or waits.
    void show(Prompt prompt);
    bool isHeld() const;
    /// True if the operator has confirmed the prompt; isGivenUp(): if the operator cannot do it.
    bool isConfirmed() const { return act_.has_value() && act_->type == Act::Type::CONFIRM; }
    bool isGivenUp() const { return act_.has_value() && act_->type == Act::Type::CANNOT; }

    /// Switches the machine on with the drive of one joint, after the operator has confirmed. NONE: the
    /// machine is on.
    Flow<Fault> enable(int joint, std::string step, std::string text);
    /// As enable(), with the drives of all motors of the joint's axis.
    Flow<Fault> enable_axis(int joint, std::string step, std::string text);
    /// Moves a joint by these distances, one after the other, only while the button is pressed. If a motion
    /// does not begin or end as requested, the machine is switched off.
    Flow<Ending> move_while_held(int joint, const Motion &motion, Prompt prompt);
    Flow<Ending> move_while_held(int joint, const std::vector<Motion> &motions, Prompt prompt);
    Flow<Ending> move_while_held(int joint, const std::vector<Motion> &motions, Prompt prompt,
                                 const Watch &watch);
    /// Waits until the joint is at standstill, also by its feedback. False: it does not stop, and the machine
    /// is switched off.
    Flow<bool> settle(int joint);

    /// Restarts the machine with the changed answers.
    Flow<> restart();
    void want_restart() { isRestartWanted_ = true; }
    /// `why` is used as the reason unless the machine has reported one.
    void switch_off_because(std::string why);
    /// The reason why the machine was switched off: found here, or reported by the machine.
    std::string why_off() const;

  private:
    static constexpr double FOREVER_S = 1e12;

    Flow<Fault> enable_joints(std::vector<int> joints, Prompt prompt);
    /// A coroutine. The functions above are not coroutines, because GCC 12 destroys arguments of a co_await
    /// that it has copied twice.
    Flow<Ending> move_in_turn(int joint, std::vector<Motion> motions, Prompt prompt, Watch watch);
    Flow<Ending> move_once(int joint, Motion motion, const Watch &watch);
    /// True if the button was released, or the operator has answered.
    bool isInterrupted() const { return !isHeld() || act_.has_value(); }

    Bench *bench_ = nullptr;
    bool isRestartWanted_ = false;
    std::coroutine_handle<> waiting_;
    Prompt prompt_;
    int prompt_number_ = 0;
    std::optional<Act> act_;
    double held_until_s_ = -1;
    std::string why_off_;
};

}  // namespace mw::commissioning

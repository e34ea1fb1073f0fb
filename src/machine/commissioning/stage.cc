// SPDX-License-Identifier: GPL-2.0-or-later
#include "machine/commissioning/stage.hh"

#include <algorithm>
#include <cmath>

#include "base/text.hh"

namespace mw::commissioning {
namespace {

/// Lease of a button: it counts as released if its client does not renew it in this time [s].
constexpr double HOLD_LEASE_S = 0.25;
constexpr double SWITCHING_TIMEOUT_S = 5;
/// A request to the machine is visible in its state within this time [s].
constexpr double REACTION_S = 0.2;

}  // namespace

Fault fault_of(Ending ending) {
    return ending == Ending::STOPPED  ? Fault::STOPPED
           : ending == Ending::CANNOT ? Fault::GIVEN_UP
                                      : Fault::NONE;
}

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
    if (act.type == Act::Type::HOLD || act.type == Act::Type::RELEASE) {
        const bool is_held = act.type == Act::Type::HOLD && prompt_.ask == Ask::HOLD;
        held_until_s_ = is_held ? bench_->now_s() + HOLD_LEASE_S : -1;
        return prompt_.ask == Ask::HOLD;
    }
    const bool may_confirm =
        prompt_.ask == Ask::CONFIRM || (prompt_.ask == Ask::HOLD && prompt_.may_end_early);
    const bool fits = act.type == Act::Type::CONFIRM ? may_confirm
                      : act.type == Act::Type::NUMBER
                          ? prompt_.ask == Ask::NUMBER && std::isfinite(act.number)
                          : prompt_.ask == Ask::CHOICE &&
                                std::ranges::find(prompt_.choices, act.choice) != prompt_.choices.end();
    if (fits) {
        act_ = act;
    }
    return fits;
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

Flow<std::optional<double>> Stage::measure(Prompt prompt, double patience_s) {
    prompt.ask = Ask::NUMBER;
    show(std::move(prompt));
    const double end_s = bench().now_s() + patience_s;
    while (!act_.has_value() && bench().now_s() < end_s) {
        co_await next_cycle();
    }
    const bool is_measured = act_.has_value() && act_->type == Act::Type::NUMBER;
    co_return is_measured ? std::optional(act_->number) : std::nullopt;
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

Flow<Fault> Stage::enable_joints(std::vector<int> joints, Prompt prompt) {
    prompt.watch = "The emergency stop must be within reach.";
    const bool confirmed = co_await confirm(std::move(prompt));
    if (!confirmed) {
        co_return Fault::GIVEN_UP;
    }
    why_off_.clear();
    bench().switch_on(joints);
    const double end_s = bench().now_s() + SWITCHING_TIMEOUT_S;
    while (!bench().isOn() && bench().now_s() < end_s) {
        co_await next_cycle();
    }
    if (!bench().isOn()) {
        switch_off_because("The machine did not switch on.");
        co_return Fault::STOPPED;
    }
    co_return Fault::NONE;
}

Flow<Fault> Stage::enable(int joint, std::string step, std::string text) {
    Prompt prompt = make_prompt(std::move(step), joint >= 0 ? motor(joint).name : "", std::move(text));
    prompt.hazards = {"The motor may start unexpectedly.", "Keep hands and tools out of the machine."};
    if (joint >= 0 && isOneOfTwo(joint)) {
        prompt.hazards.emplace_back("Two motors move this axis. Uncouple this motor from the axis first: "
                                    "alone it would rack the gantry.");
    }
    return enable_joints(joint >= 0 ? std::vector<int>{joint} : std::vector<int>{}, std::move(prompt));
}

Flow<Fault> Stage::enable_axis(int joint, std::string step, std::string text) {
    Prompt prompt = make_prompt(std::move(step), motor(joint).name, std::move(text));
    prompt.hazards = {"The motor may start unexpectedly.", "Keep hands and tools out of the machine."};
    return enable_joints(joints_of_axis(joint), std::move(prompt));
}

void Stage::switch_off_because(std::string why) {
    why_off_ = bench().last_error().empty() ? std::move(why) : "";
    bench().switch_off();
}

std::string Stage::why_off() const {
    return !why_off_.empty() || bench_ == nullptr ? why_off_ : bench_->last_error();
}

Flow<bool> Stage::settle(int joint) {
    constexpr double QUIET_S = 0.2, PATIENCE_S = 5, QUIET_MM = 0.02;
    const double quiet = plan().small(axis(joint), QUIET_MM);
    const double end_s = bench().now_s() + PATIENCE_S;
    double since_s = bench().now_s(), least = bench().joint(joint).feedback, most = least;
    while (bench().now_s() < since_s + QUIET_S) {
        co_await next_cycle();
        const JointReading reading = bench().joint(joint);
        least = std::min(least, reading.feedback);
        most = std::max(most, reading.feedback);
        if (reading.isMoving || most - least > quiet) {
            since_s = bench().now_s();
            least = most = reading.feedback;
        }
        if (bench().now_s() > end_s) {
            switch_off_because("The axis does not come to standstill.");
            co_return false;
        }
    }
    co_return true;
}

Flow<Ending> Stage::move_while_held(int joint, const Motion &motion, Prompt prompt) {
    return move_in_turn(joint, {motion}, std::move(prompt), {});
}

Flow<Ending> Stage::move_while_held(int joint, const std::vector<Motion> &motions, Prompt prompt) {
    return move_in_turn(joint, motions, std::move(prompt), {});
}

Flow<Ending> Stage::move_while_held(int joint, const std::vector<Motion> &motions, Prompt prompt,
                                    const Watch &watch) {
    return move_in_turn(joint, motions, std::move(prompt), watch);
}

Flow<Ending> Stage::move_in_turn(int joint, std::vector<Motion> motions, Prompt prompt, Watch watch) {
    prompt.ask = Ask::HOLD;
    show(std::move(prompt));
    Ending ending = Ending::DONE;
    for (std::size_t i = 0; i < motions.size() && ending == Ending::DONE; ++i) {
        ending = co_await move_once(joint, motions[i], watch);
    }
    co_return ending;
}

/// The target is fixed at the start, so that a repeated request does not add distance.
Flow<Ending> Stage::move_once(int joint, Motion motion, const Watch &watch) {
    const double stopping_s = 1 + 2 * motion.speed / axis(joint).acceleration;
    const double target = bench().joint(joint).command + motion.distance;
    const double near = std::abs(motion.distance) * 1e-6 + 1e-9;
    bool is_requested = false;
    double since_s = bench().now_s(), from = target;
    while (bench().isOn()) {
        const JointReading reading = bench().joint(joint);
        if (watch) {
            watch(reading);
        }
        const double waited_s = bench().now_s() - since_s;
        if (is_requested && isInterrupted()) {
            bench().stop(joint);
            is_requested = false;
            since_s = bench().now_s();
        } else if (is_requested) {
            const bool is_over = !reading.isMoving && (reading.command != from || waited_s > REACTION_S);
            if (is_over && reading.command == from) {
                switch_off_because("The axis did not start to move.");
            }
            is_requested = !is_over;
        } else if (reading.isMoving || std::abs(target - reading.command) <= near || act_.has_value()) {
            if (!reading.isMoving) {
                const bool is_settled = co_await settle(joint);
                co_return !is_settled ? Ending::STOPPED
                : !act_.has_value()   ? Ending::DONE
                : isConfirmed()       ? Ending::CONFIRMED
                                      : Ending::CANNOT;
            }
            if (waited_s > stopping_s) {
                switch_off_because("The axis does not stop.");
            }
        } else if (isHeld()) {
            bench().move_to(joint, target, motion.speed);
            is_requested = true;
            since_s = bench().now_s();
            from = reading.command;
        }
        co_await next_cycle();
    }
    co_return Ending::STOPPED;
}

Flow<> Stage::restart() {
    bench().switch_off();
    constexpr double SETTLE_S = 0.2;
    co_await wait(SETTLE_S);
    isRestartWanted_ = true;
    // The machine's side attaches a new bench before the next cycle. Cards on a serial bus may need a long
    // time.
    co_await next_cycle();
    constexpr double START_S = 1;
    co_await wait(START_S);
}

}  // namespace mw::commissioning

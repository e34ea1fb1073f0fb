// SPDX-License-Identifier: GPL-2.0-or-later
#include "campaign/session.hh"

#include <algorithm>
#include <bit>
#include <cctype>
#include <cmath>

#include <fmt/format.h>

namespace mw::campaign {
namespace {

constexpr double PERIOD_S = 1e-3;

/// A reason without its figures, so that equal reasons are counted together.
std::string kind_of(const std::string &reason) {
    std::string out;
    const std::size_t place = reason.find(".ngc:");
    const std::size_t text = place == std::string::npos ? 0 : reason.find(": ", place);
    for (const char c : reason.substr(text == 0 ? 0 : text + 2)) {
        const bool isFigure = std::isdigit(static_cast<unsigned char>(c)) != 0 || c == '.' || c == '-';
        if (!isFigure) {
            out += c == '\n' || c == '|' ? ' ' : c;
        } else if (out.empty() || out.back() != '#') {
            out += '#';
        }
    }
    return out;
}

}  // namespace

Session::Session(const Plan &plan, std::filesystem::path folder, const Telling &telling)
    : plan_(plan), folder_(std::move(folder)), tell_(telling.stream), judge_(plan.design, PERIOD_S) {
    judge_.known = telling.known;
    if (!telling.trace.empty()) {
        trace_.open(telling.trace);
    }
}

void Session::fail(const std::string &rule, const std::string &text) {
    if (judge_.known.contains(rule)) {
        ++verdict_.known[rule];
    } else if (verdict_.fault.empty()) {
        verdict_.fault = rule + ": " + text;
    }
}

void Session::cycle() {
    rig_->cycle();
    static_cast<void>(rig_->client().read_status());
    const Sample &s = rig_->sample();
    judge_.sample(s);
    if (trace_.is_open()) {
        trace_ << s.cycle;
        for (const JointSample &j : s.joints) {
            trace_ << fmt::format(" {:.9g}", j.motor_cmd);
        }
        for (const AxisDesign &a : plan_.design.axes) {
            trace_ << fmt::format(" {:.9g}", s.axes[a.axis]);
        }
        trace_ << fmt::format(" {:.9g} {:.9g}\n", s.spindle_rpm, s.spindle_turns);
    }
    if (isRecording_) {
        const auto motor = &JointSample::motor_cmd;
        const bool isLed = s.axes == path_.front() && !std::ranges::equal(s.joints, led_, {}, motor, motor);
        led_s_ += isLed && !led_.empty() ? PERIOD_S : 0.0;
        led_ = s.joints;
        path_.push_back(s.axes);
        turns_.push_back(s.spindle_turns);
        rpm_.push_back(s.spindle_rpm);
    }
    for (const JointSample &j : s.joints) {
        verdict_.hash = (verdict_.hash ^ std::bit_cast<std::uint64_t>(j.motor_cmd)) * 0x100000001b3U;
    }
    if (act_ != nullptr && act_->work == Work::PROBE) {
        for (const Contact &c : act_->contacts) {
            beyond_walls_[c.axis] = std::max(beyond_walls_[c.axis], rig_->beyond_walls(c.axis));
        }
    }
    while (const auto message = rig_->client().next_message()) {
        if (isRecording_) {
            told_.push_back(message->text);
        }
        if (tell_ != nullptr) {
            std::fprintf(tell_, "  [%.3f] %s\n", static_cast<double>(s.cycle) * PERIOD_S,
                         message->text.c_str());
        }
    }
    if (!judge_.isSound()) {
        fail(judge_.report().substr(0, judge_.report().find(':')),
             judge_.report().substr(judge_.report().find(':') + 2));
    }
}

client::Serial Session::post(const messages::Command &command) {
    ++verdict_.commands;
    const auto posted = rig_->client().post(command);
    if (!posted) {
        fail("command", posted.error().str());
        return 0;
    }
    return *posted;
}

Session::End Session::wait(client::Serial command, double most_s) {
    for (double t = 0; t < most_s && !isOver(); t += PERIOD_S) {
        const client::Outcome outcome = rig_->client().outcome(command);
        switch (outcome.progress) {
        case messages::Progress::DONE: return End::DONE;
        case messages::Progress::REFUSED:
        case messages::Progress::FAILED:
            ++verdict_.refused;
            ++verdict_.refusals[kind_of(outcome.reason)];
            if (tell_ != nullptr) {
                std::fprintf(tell_, "  refused: %s\n", outcome.reason.c_str());
            }
            return outcome.progress == messages::Progress::REFUSED ? End::REFUSED : End::FAILED;
        case messages::Progress::STARTED: break;
        }
        step_troubles();
        cycle();
    }
    return End::LATE;
}

Session::End Session::ask(const messages::Command &command, double most_s) {
    return wait(post(command), most_s);
}

/// Runs until nothing moves, and a short time longer.
void Session::settle(double most_s) {
    double t = 0;
    for (int calm = 0; calm < 20 && t < most_s && !isOver(); t += PERIOD_S) {
        cycle();
        calm = judge_.isAtRest() && judge_.areOffsetsAtRest() ? calm + 1 : 0;
    }
    if (t >= most_s) {
        fail("work", "it does not stop");
    }
}

messages::State Session::state() {
    return rig_->client().status().task.state;
}

bool Session::set_mode(messages::Mode mode) {
    const int sure = static_cast<int>(judge_.time_to_be_sure() / PERIOD_S);
    for (int i = 0; i < sure && !rig_->isInPosition() && !isOver(); ++i) {
        cycle();
    }
    const End end = ask(messages::SetMode{mode});
    if (end != End::DONE && !isStopped_) {
        fail("work", "the mode is not set with the machine at rest");
    }
    return end == End::DONE;
}

/// Motors coast when they are switched off at speed. Switching on while they coast may cause following
/// errors, because no drive stops them immediately.
void Session::await_slides() {
    constexpr double STANDING = 1e-3, MOST_S = 20;  // an encoder count, as read by motion
    int calm = 0;
    for (double t = 0; calm < 20 && t < MOST_S && !isOver(); t += PERIOD_S) {
        const std::vector<JointSample> before = rig_->sample().joints;
        cycle();
        const bool areStanding = std::ranges::equal(
            before, rig_->sample().joints, [](double a, double b) { return !(std::abs(a - b) > STANDING); },
            &JointSample::motor_fb, &JointSample::motor_fb);
        calm = areStanding ? calm + 1 : 0;
    }
}

bool Session::switch_on() {
    constexpr int TRIES = 3;
    for (int i = 0; i < TRIES && !isOver() && state() != messages::State::ON; ++i) {
        ask(messages::SetState{messages::State::ESTOP_RESET});
        judge_.allow(Leave::SWITCH_ON);
        ask(messages::SetState{messages::State::ON});
        settle(LONGEST_CALM_S);
        if (state() != messages::State::ON) {
            await_slides();
        }
    }
    if (!isOver() && state() != messages::State::ON) {
        fail("work", "the machine cannot be switched on with nothing wrong");
    }
    return !isOver();
}

bool Session::home() {
    if (!set_mode(messages::Mode::MANUAL)) {
        return false;
    }
    ask(messages::SetTeleop{false});
    settle(LONGEST_CALM_S);
    judge_.allow(Leave::MOVE);
    ask(messages::UnhomeJoint{-1});
    if (isStopped_) {
        return false;  // an operator who stops the machine does not home it at once
    }
    const End end = ask(messages::HomeJoint{-1}, 120);
    settle(5);
    if (!isOver() && !isStopped_ && end != End::DONE) {
        fail("work", "homing does not end well with nothing wrong");
    }
    return !isOver() && end == End::DONE;
}

/// Clears the external offsets. An offset stays active as long as the axis would be outside its limits
/// without it.
bool Session::clear_offsets() {
    if (!set_mode(messages::Mode::MANUAL) || ask(messages::SetTeleop{true}) != End::DONE) {
        return false;
    }
    settle(LONGEST_CALM_S);
    judge_.allow(Leave::MOVE);
    for (const AxisDesign &a : plan_.design.axes) {
        const double place = rig_->sample().axes[a.axis];
        const double inside = std::clamp(place, a.low, a.high);
        if (inside != place) {
            ask(messages::JogIncrement{false, a.axis, a.velocity, inside - place});
        }
    }
    rig_->clear_offsets(true);
    constexpr int MOST_MS = 20000;
    for (int i = 0; i < MOST_MS && rig_->hasOffset() && !isOver(); ++i) {
        cycle();
    }
    if (rig_->hasOffset()) {
        fail("offset", "an external offset is not cleared");
    }
    rig_->clear_offsets(false);
    cycle();
    if (!judge_.isAtRest()) {
        settle(10);  // an axis far outside a limit needs longer than the offset
    }
    return !isOver();
}

/// Repairs, switches on and homes the machine, so that only its own faults stop the next act.
bool Session::prepare() {
    act_ = nullptr;
    going_.clear();
    rig_->set_contacts({});
    rig_->link_wheel(nullptr, 0);
    judge_.stops_later_s = 0;
    judge_.back_to.reset();
    isStopped_ = isDisturbed_ = isReversed_ = false;
    rig_->repair();
    for (int i = 0; i < 5 && !isOver(); ++i) {
        cycle();
    }
    settle(10);
    if (!areEncodersTrue_ && rig_->isAskew()) {
        ask(messages::SetState{messages::State::OFF});
        settle(10);
        rig_->straighten();
        cycle();
    }
    if (isOver() || !switch_on()) {
        return false;
    }
    ask(messages::SetFeedOverride{1});
    ask(messages::SetRapidOverride{1});
    if (!areEncodersTrue_ || !rig_->client().status().trajectory.isAllHomed) {
        if (!home()) {
            return false;
        }
        rig_->trust_encoders();
        areEncodersTrue_ = true;
    }
    if (plan_.design.hasSpindlePlant) {
        ask(messages::SetSpindleOverride{1, 0});
    }
    return !isOver() && (!rig_->hasOffset() || clear_offsets());
}

Verdict Session::run() {
    rig_ = std::make_unique<Rig>(plan_.design, plan_.seed, plan_.design.write(folder_));
    if (const std::string error = rig_->start(); !error.empty()) {
        fail("start", error);
        return verdict_;
    }
    for (std::size_t n = 0; n < plan_.acts.size() && !isOver(); ++n) {
        const bool isLast = n + 1 == plan_.acts.size();
        if (!isLast && static_cast<double>(rig_->sample().cycle) * PERIOD_S > plan_.least_s) {
            continue;
        }
        if (tell_ != nullptr) {
            std::fprintf(tell_, "act %zu\n", n);
        }
        if (prepare()) {
            perform(plan_.acts[n]);
        }
    }
    verdict_.seconds = static_cast<double>(rig_->sample().cycle) * PERIOD_S;
    for (const auto &[rule, count] : judge_.broken_known()) {
        verdict_.known[rule] += count;
    }
    if (!plan_.design.isTrivial) {
        Extension &count = verdict_.extensions["kinematics " + plan_.design.name];
        count.ran = verdict_.programs;
        count.judged = verdict_.ended;
    }
    for (const JointDesign &j : plan_.design.joints) {
        verdict_.extensions["backlash"].ran += j.backlash > 0 ? 1 : 0;
        verdict_.extensions["screw"].ran += j.screw_type >= 0 ? 1 : 0;
    }
    for (const auto &[name, count] : judge_.judged()) {
        verdict_.extensions[name].judged += count;
    }
    verdict_.slowest_stop = judge_.slowest_stop();
    return verdict_;
}

void Session::perform(const Act &act) {
    isStopped_ = isDisturbed_ = false;
    switch (act.work) {
    case Work::PROGRAM:
    case Work::PROBE:
    case Work::SPINDLE: run_program(act); break;
    case Work::JOG_JOINT:
    case Work::JOG_AXIS: jog(act); break;
    case Work::WHEEL: turn(act); break;
    case Work::HOME:
        begin_troubles(act);
        home();
        break;
    }
    // Faults that are due after the end of the work occur, too.
    for (int i = 0; i < 100 && !isOver(); ++i) {
        step_troubles();
        cycle();
    }
    settle(30);
    if (isProgram(act.work) && plan_.design.hasOffsets() && !isStopped_ && !isOver()) {
        Extension &count = verdict_.extensions["offsets"];
        count.ran += rig_->hasOffset() ? 1 : 0;
        for (int i = 0; i < 20000 && !rig_->areOffsetsThere() && !isOver(); ++i) {
            cycle();
        }
        count.judged += rig_->hasOffset() ? 1 : 0;
        if (!rig_->areOffsetsThere() && !isOver()) {
            fail("offset", "an external offset does not get where it is asked to be");
        }
    }
}

}  // namespace mw::campaign

// SPDX-License-Identifier: GPL-2.0-or-later
// Faults during a run, and actions of other operators at the same time.
#include <utility>

#include "task_campaign/session.hh"

namespace mw::task_campaign {

void Session::begin_troubles(const Act &act) {
    act_ = &act;
    began_ms_ = bench_.now_ms();
    next_trouble_ = 0;
    isStopped_ = areDevicesOff_ = isCrashed_ = isHeldByUs_ = false;
}

/// Result of a fault, after the machine has stopped.
void Session::note_stop() {
    settle();
    if (!areDevicesOff_ || isCrashed_) {
        return;
    }
    beliefs_.switch_devices_off();
}

void Session::step_troubles() {
    const std::int64_t now = bench_.now_ms() - began_ms_;
    while (!isCrashed_ && !isOver() && next_trouble_ < act_->troubles.size() &&
           act_->troubles[next_trouble_].at_ms <= now) {
        begin(act_->troubles[next_trouble_++]);
    }
}

void Session::begin(const Trouble &t) {
    ++verdict_.counts[name_of(t.what)];
    tell(name_of(t.what));
    isStopped_ = isStopped_ || isEnding(t.what);
    const bool isEstop = t.what == Upset::ESTOP || t.what == Upset::CHAIN;
    areDevicesOff_ = areDevicesOff_ || isEstop || t.what == Upset::ABORT || t.what == Upset::OFF;
    if (areDevicesOff_ && status().task.isAway) {
        // Faults in which the axes were jogged where motion had released them.
        const bool areLetGo = status().trajectory.mode != messages::MotionMode::COORD;
        mode_ = areLetGo ? messages::Mode::MANUAL : mode_;
    }
    const bool goesOff = t.what == Upset::OFF && beliefs_.state == messages::State::ON;
    beliefs_.state = isEstop ? messages::State::ESTOP : goesOff ? messages::State::OFF : beliefs_.state;
    switch (t.what) {
    case Upset::PAUSE: post(t.client, messages::PauseProgram{}); break;
    case Upset::STEP:
        post(t.client, messages::PauseProgram{});
        cycles(t.length_ms);
        for (int i = 0; i < 3 && isRunning(); ++i) {  // this would start the program if none is running
            post(t.client, messages::StepProgram{});
            cycles(t.length_ms);
        }
        break;
    case Upset::LEAVE: leave(t); break;
    case Upset::OVERRIDE:
        beliefs_.feed_override = static_cast<double>(t.seed % 16 + 4) / 10;
        ask(t.client, messages::SetFeedOverride{beliefs_.feed_override}, Expected::TAKEN);
        break;
    case Upset::ODD: try_odd(t.client, t.seed, false); break;
    case Upset::CLIENT_GONE:
        forget_orders(t.client);
        bench_.lose_client(t.client);
        break;
    case Upset::ABORT: ask(t.client, messages::AbortAll{}, Expected::TAKEN); break;
    case Upset::RESET_INTERPRETER: break;
    case Upset::OFF: ask(t.client, messages::SetState{messages::State::OFF}, Expected::TAKEN); break;
    case Upset::ESTOP: ask(t.client, messages::SetState{messages::State::ESTOP}, Expected::TAKEN); break;
    case Upset::CHAIN:
        *bench_.pins().chain = false;
        cycles(t.length_ms);
        *bench_.pins().chain = true;
        break;
    case Upset::CHANGER_FAULT: bench_.changer.isFaulted = true; break;
    case Upset::KILLED:
    case Upset::POWER_CUT: crash(t.what == Upset::POWER_CUT); break;
    }
}

/// The tool is removed from a held program and returned.
void Session::leave(const Trouble &t) {
    isHeldByUs_ = true;
    ask(t.client, messages::PauseProgram{});
    cycles(t.length_ms);
    if (ask(t.client, messages::ReleaseAxes{}) == messages::Progress::DONE) {
        ++verdict_.counts["axes released"];
        ask(t.client, messages::JogIncrement{false, 2, 100, 3.0});
        cycles(60);
    }
    isHeldByUs_ = false;
}

void Session::crash(bool isPowerCut) {
    isCrashed_ = true;
    wasRunning_ = isRunning();
    const std::uint64_t ended = status().task.programs_ended - ended_before_;
    runs_before_crash_ = wasRunning_ || ended == 0 ? ended : ended - 1;
    ++verdict_.crashes;
    forget_orders(-1);
    bench_.die(isPowerCut);
    const std::string trouble = bench_.come_up();
    if (!trouble.empty()) {
        fail("start", "after a crash: " + trouble);
        return;
    }
    beliefs_.state = messages::State::ESTOP;
    mode_ = messages::Mode::MANUAL;
    beliefs_.isHomed = false;
    wasOptionalStop_ = std::exchange(beliefs_.isOptionalStop, true);
    wasBlockDelete_ = std::exchange(beliefs_.isBlockDelete, true);
    beliefs_.feed_override = 1;
    cycle();
}

}  // namespace mw::task_campaign

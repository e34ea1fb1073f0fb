// SPDX-License-Identifier: GPL-2.0-or-later
// What operators do besides programs and lines.
#include <algorithm>
#include <functional>

#include "task_campaign/session.hh"

namespace mw::task_campaign {

void Session::perform(const Act &act) {
    act_ = &act;
    isStopped_ = isCrashed_ = false;
    switch (act.work) {
    case Work::PROGRAM:
    case Work::FROM_LINE: run_program(act); break;
    case Work::MDI: run_mdi(act); break;
    case Work::SWITCHES: turn_switches(act); break;
    case Work::BY_HAND: work_by_hand(act); break;
    case Work::JOG: jog(act); break;
    case Work::HOME: home(act); break;
    case Work::TABLE: set_table(act); break;
    case Work::STATE: change_state(act); break;
    case Work::ODD:
        for (int i = 0; i < 6 && !isOver(); ++i) {
            try_odd((act.client + i) % CLIENTS, act.seed + static_cast<std::uint64_t>(i) * 7919, true);
        }
        break;
    case Work::OPERATE: operate_alone(act); break;
    case Work::CRASH: {
        std::vector<World> after;
        for (const World &world : beliefs_.worlds) {
            after.push_back(after_crash(world));
        }
        beliefs_.worlds = std::move(after);
        crash(act.seed % 2 == 0);
        break;
    }
    }
}

void Session::turn_switches(const Act &act) {
    beliefs_.isOptionalStop = (act.seed & 1U) != 0;
    beliefs_.isBlockDelete = (act.seed & 2U) != 0;
    beliefs_.feed_override = static_cast<double>(act.seed % 15 + 5) / 10;
    ask(act.client, msgs::SetOptionalStop{beliefs_.isOptionalStop}, Expected::TAKEN);
    ask(act.client, msgs::SetBlockDelete{beliefs_.isBlockDelete}, Expected::TAKEN);
    ask(act.client, msgs::SetFeedOverride{beliefs_.feed_override}, Expected::TAKEN);
}

void Session::work_by_hand(const Act &act) {
    if (!prepare(msgs::Mode::MANUAL)) {
        return;
    }
    sim::Random random(act.seed);
    const int rpm = random.whole(2, 30) * 100;
    const int direction = random.whole(-1, 1);
    const bool isMist = random.chance(0.5), isFlood = random.chance(0.5);
    ask(act.client, msgs::SpindleOn{0, static_cast<double>(direction * rpm)}, Expected::TAKEN);
    isMist ? ask(act.client, msgs::MistOn{}, Expected::TAKEN)
           : ask(act.client, msgs::MistOff{}, Expected::TAKEN);
    isFlood ? ask(act.client, msgs::FloodOn{}, Expected::TAKEN)
            : ask(act.client, msgs::FloodOff{}, Expected::TAKEN);
    for (World &world : beliefs_.worlds) {
        world.doings.direction = direction;
        world.doings.turning_rpm = direction == 0 ? 0 : rpm;
        world.doings.isMist = isMist;
        world.doings.isFlood = isFlood;
    }
}

void Session::jog(const Act &act) {
    if (!prepare(msgs::Mode::MANUAL)) {
        return;
    }
    const int axis = static_cast<int>(act.seed % AXES);
    const double by = act.seed % 2 == 0 ? 4.0 : -4.0;
    ask(act.client, msgs::JogIncrement{false, axis, 200, by});
    settle();
    adopt_place(bench_, beliefs_);
}

void Session::home(const Act &act) {
    if (!prepare(msgs::Mode::MANUAL)) {
        return;
    }
    ask(act.client, msgs::SetTeleop{false}, Expected::TAKEN);  // joints are unhomed in joint mode
    ask(act.client, msgs::UnhomeJoint{-1}, Expected::TAKEN);
    beliefs_.isHomed = status().trajectory.isAllHomed;
    settle();
    if (beliefs_.isHomed) {
        fail("home", "it is homed after UnhomeJoint");
        return;
    }
    ask(act.client, msgs::SetMode{msgs::Mode::MDI}, Expected::TAKEN);
    ask(act.client, msgs::Mdi{"G0 X1"}, Expected::REFUSED);
}

/// By a message, and by another program that writes the file.
void Session::set_table(const Act &act) {
    sim::Random random(act.seed);
    Doings d = beliefs_.worlds[0].doings;
    Tool &tool = d.tools[static_cast<std::size_t>(random.whole(0, static_cast<int>(d.tools.size()) - 1))];
    tool.z = random.whole(-10, 10) * 0.25;
    if (random.chance(0.5)) {
        msgs::SetToolEntry entry;
        entry.toolno = tool.number;
        entry.pocket = tool.pocket;
        entry.offset[2] = tool.z;
        ask(act.client, entry, Expected::TAKEN);
    } else {
        bench_.write_tool_table(d.tools);
        ask(act.client, msgs::LoadToolTable{}, Expected::TAKEN);
    }
    for (World &world : beliefs_.worlds) {
        world.doings.tools = d.tools;
    }
}

void Session::change_state(const Act &act) {
    const msgs::State states[] = {msgs::State::OFF, msgs::State::ESTOP};
    const msgs::State wanted = states[act.seed % 2];
    if (beliefs_.state != msgs::State::ON && wanted == msgs::State::OFF) {
        return;
    }
    ask(act.client, msgs::SetState{wanted}, Expected::TAKEN);
    settle();
    beliefs_.state = status().task.state;
    if (beliefs_.state == msgs::State::ON ||
        (wanted == msgs::State::ESTOP && beliefs_.state != msgs::State::ESTOP)) {
        fail("state", "the machine is on after it was switched off");
    }
    beliefs_.switch_devices_off();
}

/// One of a heap. At rest it is known whether it must be taken; else it must have an end.
void Session::try_odd(int client, std::uint64_t seed, bool isAtRest) {
    using msgs::Mode;
    using msgs::State;
    const bool isOn = beliefs_.state == State::ON;
    const auto taken_if = [](bool is) { return is ? Expected::TAKEN : Expected::REFUSED; };
    struct Odd {
        msgs::Command command;
        Expected expected;
    };
    const Odd all[] = {
        {msgs::PauseProgram{}, taken_if(isOn)},
        {msgs::ResumeProgram{}, taken_if(isOn)},
        {msgs::ForwardProgram{}, Expected::REFUSED},
        {msgs::ConfirmApproach{77}, Expected::REFUSED},
        {msgs::ReleaseAxes{}, Expected::REFUSED},
        {msgs::StepTraj{}, taken_if(false)},
        {msgs::LinearMove{}, Expected::REFUSED},
        {msgs::EndProgram{}, Expected::REFUSED},
        {msgs::SystemCommand{"true"}, Expected::REFUSED},
        {msgs::InitTask{}, Expected::REFUSED},
        {msgs::SetJointBacklash{}, taken_if(isOn && mode_ == Mode::MANUAL)},
        {msgs::SetJointMinLimit{0, 1e9}, Expected::REFUSED},
        {msgs::Null{}, Expected::TAKEN},
        {msgs::OperatorText{"hello"}, Expected::TAKEN},
        {msgs::SynchInterpreter{}, Expected::TAKEN},
        {msgs::LoadToolTable{}, Expected::TAKEN},
        {msgs::Mdi{"G4 P0"}, taken_if(isOn && mode_ == Mode::MDI && beliefs_.isHomed)},
        {msgs::HomeJoint{}, isOn && mode_ == Mode::MANUAL ? Expected::ANY : Expected::REFUSED},
        {msgs::JogIncrement{true, 0, 10, 0.5}, Expected::ANY},
        {msgs::RunProgram{-1}, Expected::REFUSED},
        {msgs::SetMode{Mode::AUTO}, Expected::TAKEN},
        {msgs::SetMode{Mode::MDI}, Expected::TAKEN},
        {msgs::SetMode{Mode::MANUAL}, Expected::TAKEN},
        {msgs::AbortAll{}, Expected::TAKEN},
        {msgs::JogStop{true, 0}, Expected::TAKEN},
        {msgs::SetFeedOverride{beliefs_.feed_override}, Expected::TAKEN},
    };
    std::size_t choice = seed % std::size(all);
    if (!isAtRest) {
        // What would end or change the run is a trouble of its own.
        const bool isOther = std::holds_alternative<msgs::AbortAll>(all[choice].command) ||
                             std::holds_alternative<msgs::Mdi>(all[choice].command) ||
                             std::holds_alternative<msgs::StepTraj>(all[choice].command);
        post(client, isOther ? msgs::Command{msgs::Null{}} : all[choice].command);
        return;
    }
    if (std::holds_alternative<msgs::StepTraj>(all[choice].command)) {
        choice = 0;  // where nothing runs it begins a program
    }
    const Odd &odd = all[choice];
    const bool isDone = ask(client, odd.command, odd.expected) == msgs::Progress::DONE;
    if (isDone && std::holds_alternative<msgs::HomeJoint>(odd.command)) {
        beliefs_.isHomed = true;
    }
    const bool isStop = std::holds_alternative<msgs::AbortAll>(odd.command);
    if (isStop) {
        beliefs_.switch_devices_off();
    }
    settle();
    const bool hasMoved = std::holds_alternative<msgs::HomeJoint>(odd.command) ||
                          std::holds_alternative<msgs::JogIncrement>(odd.command);
    if (hasMoved) {
        adopt_place(bench_, beliefs_);
    }
}

/// Others are refused but for stops; the right ends with its client, by its word or by its time.
void Session::operate_alone(const Act &act) {
    const int holder = act.client, other = (act.client + 1) % CLIENTS, third = (act.client + 2) % CLIENTS;
    ask(holder, msgs::ClaimOperation{0.5}, Expected::TAKEN);
    ask(other, msgs::SetOptionalStop{!beliefs_.isOptionalStop}, Expected::REFUSED);
    ask(other, msgs::ClaimOperation{0.5}, Expected::REFUSED);
    ask(holder, msgs::SetOptionalStop{beliefs_.isOptionalStop}, Expected::TAKEN);
    switch (act.seed % 4) {
    case 0: ask(holder, msgs::ReleaseOperation{}, Expected::TAKEN); break;
    case 1: cycles(700); break;
    case 2:
        bench_.lose_client(holder);
        cycles(1200);
        break;
    default:
        ask(holder, msgs::HandOverOperation{bench_.client(third).id()}, Expected::TAKEN);
        ask(holder, msgs::SetOptionalStop{!beliefs_.isOptionalStop}, Expected::REFUSED);
        ask(third, msgs::ReleaseOperation{}, Expected::TAKEN);
        break;
    }
    ask(other, msgs::SetOptionalStop{beliefs_.isOptionalStop}, Expected::TAKEN);
}

}  // namespace mw::task_campaign

// SPDX-License-Identifier: GPL-2.0-or-later
// Acts of operators other than programs and lines.
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
    ask(act.client, messages::SetOptionalStop{beliefs_.isOptionalStop}, Expected::TAKEN);
    ask(act.client, messages::SetBlockDelete{beliefs_.isBlockDelete}, Expected::TAKEN);
    ask(act.client, messages::SetFeedOverride{beliefs_.feed_override}, Expected::TAKEN);
}

void Session::work_by_hand(const Act &act) {
    if (!prepare(messages::Mode::MANUAL)) {
        return;
    }
    plants::Random random(act.seed);
    const int rpm = random.whole(2, 30) * 100;
    const int direction = random.whole(-1, 1);
    const bool isMist = random.chance(0.5), isFlood = random.chance(0.5);
    ask(act.client, messages::SpindleOn{0, static_cast<double>(direction * rpm)}, Expected::TAKEN);
    isMist ? ask(act.client, messages::MistOn{}, Expected::TAKEN)
           : ask(act.client, messages::MistOff{}, Expected::TAKEN);
    isFlood ? ask(act.client, messages::FloodOn{}, Expected::TAKEN)
            : ask(act.client, messages::FloodOff{}, Expected::TAKEN);
    for (World &world : beliefs_.worlds) {
        world.doings.direction = direction;
        world.doings.turning_rpm = direction == 0 ? 0 : rpm;
        world.doings.isMist = isMist;
        world.doings.isFlood = isFlood;
    }
}

void Session::jog(const Act &act) {
    if (!prepare(messages::Mode::MANUAL)) {
        return;
    }
    const int axis = static_cast<int>(act.seed % AXES);
    const double by = act.seed % 2 == 0 ? 4.0 : -4.0;
    ask(act.client, messages::JogIncrement{false, axis, 200, by});
    settle();
    adopt_place(bench_, beliefs_);
}

void Session::home(const Act &act) {
    if (!prepare(messages::Mode::MANUAL)) {
        return;
    }
    ask(act.client, messages::SetTeleop{false}, Expected::TAKEN);  // joints are unhomed in joint mode
    ask(act.client, messages::UnhomeJoint{-1}, Expected::TAKEN);
    beliefs_.isHomed = status().trajectory.isAllHomed;
    settle();
    if (beliefs_.isHomed) {
        fail("home", "it is homed after UnhomeJoint");
        return;
    }
    ask(act.client, messages::SetMode{messages::Mode::MDI}, Expected::TAKEN);
    ask(act.client, messages::Mdi{"G0 X1"}, Expected::REFUSED);
}

/// Sets the table by a message, or by another program that writes the file.
void Session::set_table(const Act &act) {
    plants::Random random(act.seed);
    Doings d = beliefs_.worlds[0].doings;
    Tool &tool = d.tools[static_cast<std::size_t>(random.whole(0, static_cast<int>(d.tools.size()) - 1))];
    tool.z = random.whole(-10, 10) * 0.25;
    if (random.chance(0.5)) {
        messages::SetToolEntry entry;
        entry.toolno = tool.number;
        entry.pocket = tool.pocket;
        entry.offset[2] = tool.z;
        ask(act.client, entry, Expected::TAKEN);
    } else {
        bench_.write_tool_table(d.tools);
        ask(act.client, messages::LoadToolTable{}, Expected::TAKEN);
    }
    for (World &world : beliefs_.worlds) {
        world.doings.tools = d.tools;
    }
}

void Session::change_state(const Act &act) {
    const messages::State states[] = {messages::State::OFF, messages::State::ESTOP};
    const messages::State wanted = states[act.seed % 2];
    if (beliefs_.state != messages::State::ON && wanted == messages::State::OFF) {
        return;
    }
    ask(act.client, messages::SetState{wanted}, Expected::TAKEN);
    settle();
    beliefs_.state = status().task.state;
    if (beliefs_.state == messages::State::ON ||
        (wanted == messages::State::ESTOP && beliefs_.state != messages::State::ESTOP)) {
        fail("state", "the machine is on after it was switched off");
    }
    beliefs_.switch_devices_off();
}

/// One of many commands. At rest it is known whether it must be accepted; otherwise it must end.
void Session::try_odd(int client, std::uint64_t seed, bool isAtRest) {
    using messages::Mode;
    using messages::State;
    const bool isOn = beliefs_.state == State::ON;
    const auto taken_if = [](bool is) { return is ? Expected::TAKEN : Expected::REFUSED; };
    struct Odd {
        messages::Command command;
        Expected expected;
    };
    const Odd all[] = {
        {messages::PauseProgram{}, taken_if(isOn)},
        {messages::ResumeProgram{}, taken_if(isOn)},
        {messages::ForwardProgram{}, Expected::REFUSED},
        {messages::ConfirmApproach{77}, Expected::REFUSED},
        {messages::ReleaseAxes{}, Expected::REFUSED},
        {messages::StepProgram{}, taken_if(false)},
        {messages::SetJointBacklash{}, taken_if(isOn && mode_ == Mode::MANUAL)},
        {messages::SetJointMinLimit{0, 1e9}, Expected::REFUSED},
        {messages::Null{}, Expected::TAKEN},
        {messages::OperatorText{"hello"}, Expected::TAKEN},
        {messages::SynchInterpreter{}, Expected::TAKEN},
        {messages::LoadToolTable{}, Expected::TAKEN},
        {messages::Mdi{"G4 P0"}, taken_if(isOn && mode_ == Mode::MDI && beliefs_.isHomed)},
        {messages::HomeJoint{}, isOn && mode_ == Mode::MANUAL ? Expected::ANY : Expected::REFUSED},
        {messages::JogIncrement{true, 0, 10, 0.5}, Expected::ANY},
        {messages::RunProgram{-1}, Expected::REFUSED},
        {messages::SetMode{Mode::AUTO}, Expected::TAKEN},
        {messages::SetMode{Mode::MDI}, Expected::TAKEN},
        {messages::SetMode{Mode::MANUAL}, Expected::TAKEN},
        {messages::AbortAll{}, Expected::TAKEN},
        {messages::JogStop{true, 0}, Expected::TAKEN},
        {messages::SetFeedOverride{beliefs_.feed_override}, Expected::TAKEN},
    };
    std::size_t choice = seed % std::size(all);
    if (!isAtRest) {
        // Commands that end or change the run are separate events.
        const bool isOther = std::holds_alternative<messages::AbortAll>(all[choice].command) ||
                             std::holds_alternative<messages::Mdi>(all[choice].command) ||
                             std::holds_alternative<messages::StepProgram>(all[choice].command);
        post(client, isOther ? messages::Command{messages::Null{}} : all[choice].command);
        return;
    }
    if (std::holds_alternative<messages::StepProgram>(all[choice].command)) {
        choice = 0;  // starts a program if none is running
    }
    const Odd &odd = all[choice];
    const bool isDone = ask(client, odd.command, odd.expected) == messages::Progress::DONE;
    if (isDone && std::holds_alternative<messages::HomeJoint>(odd.command)) {
        beliefs_.isHomed = true;
    }
    const bool isStop = std::holds_alternative<messages::AbortAll>(odd.command);
    if (isStop) {
        beliefs_.switch_devices_off();
    }
    settle();
    const bool hasMoved = std::holds_alternative<messages::HomeJoint>(odd.command) ||
                          std::holds_alternative<messages::JogIncrement>(odd.command);
    if (hasMoved) {
        adopt_place(bench_, beliefs_);
    }
}

/// Commands of other clients are rejected, except stops. The right ends with its client, on its request, or
/// by timeout.
void Session::operate_alone(const Act &act) {
    const int holder = act.client, other = (act.client + 1) % CLIENTS, third = (act.client + 2) % CLIENTS;
    ask(holder, messages::ClaimOperation{0.5}, Expected::TAKEN);
    ask(other, messages::SetOptionalStop{!beliefs_.isOptionalStop}, Expected::REFUSED);
    ask(other, messages::ClaimOperation{0.5}, Expected::REFUSED);
    ask(holder, messages::SetOptionalStop{beliefs_.isOptionalStop}, Expected::TAKEN);
    switch (act.seed % 4) {
    case 0: ask(holder, messages::ReleaseOperation{}, Expected::TAKEN); break;
    case 1: cycles(700); break;
    case 2:
        bench_.lose_client(holder);
        cycles(1200);
        break;
    default:
        ask(holder, messages::HandOverOperation{bench_.client(third).id()}, Expected::TAKEN);
        ask(holder, messages::SetOptionalStop{!beliefs_.isOptionalStop}, Expected::REFUSED);
        ask(third, messages::ReleaseOperation{}, Expected::TAKEN);
        break;
    }
    ask(other, messages::SetOptionalStop{beliefs_.isOptionalStop}, Expected::TAKEN);
}

}  // namespace mw::task_campaign

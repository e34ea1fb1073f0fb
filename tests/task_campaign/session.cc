// SPDX-License-Identifier: GPL-2.0-or-later
#include "task_campaign/session.hh"

#include <fmt/format.h>

namespace mw::task_campaign {

Session::Session(const Plan &plan, const std::filesystem::path &folder, std::FILE *tell)
    : Operators(plan, folder, tell), plan_(plan) {
    World world;
    world.doings.isRandom = plan.isRandomChanger;
    world.doings.tools = plan.tools;
    world.doings.in_spindle = plan.isRandomChanger ? plan.tools[0].number : 0;
    beliefs_.worlds = {world};
}

Verdict Session::run() {
    const std::string trouble = bench_.come_up();
    if (!trouble.empty()) {
        fail("start", trouble);
        return verdict_;
    }
    for (const Act &act : plan_.acts) {
        this->tell(fmt::format("{} by {}", name_of(act.work), act.client));
        perform(act);
        settle();
        check();
        ++verdict_.acts;
        if (isOver()) {
            break;
        }
    }
    verdict_.seconds = 1e-3 * static_cast<double>(bench_.now_ms());
    return verdict_;
}

void Session::check() {
    if (mode_under_way_ == status().task.mode) {
        mode_ = status().task.mode;
    }
    const std::string trouble = isOver() ? "" : judge(bench_, mode_, beliefs_);
    if (!trouble.empty()) {
        fail(trouble.substr(0, trouble.find(':')), trouble.substr(trouble.find(':') + 2));
    }
}

bool Session::prepare(messages::Mode mode) {
    const auto isDone = [this](const messages::Command &command) {
        const bool isTaken = ask(0, command, Expected::TAKEN) == messages::Progress::DONE;
        if (!isTaken) {
            fail("work", "the machine cannot be switched on, homed, or set to a mode");
        }
        return isTaken;
    };
    if (beliefs_.state != messages::State::ON) {
        const bool isReset = beliefs_.state != messages::State::ESTOP ||
                             isDone(messages::SetState{messages::State::ESTOP_RESET});
        if (!isReset || !isDone(messages::SetState{messages::State::ON})) {
            return false;
        }
        beliefs_.state = messages::State::ON;
    }
    if (!beliefs_.isHomed) {
        if (!isDone(messages::SetMode{messages::Mode::MANUAL}) || !isDone(messages::SetTeleop{false}) ||
            !isDone(messages::HomeJoint{})) {
            return false;
        }
        beliefs_.isHomed = true;
        settle();
        adopt_place(bench_, beliefs_);
    }
    if (mode_ != mode) {
        if (!isDone(messages::SetMode{mode})) {
            return false;
        }
    }
    return !isOver();
}

}  // namespace mw::task_campaign

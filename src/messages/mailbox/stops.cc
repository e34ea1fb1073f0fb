// SPDX-License-Identifier: GPL-2.0-or-later
#include "messages/mailbox/stops.hh"

#include <algorithm>
#include <string>
#include <vector>

#include "base/overloaded.hh"
#include "messages/declarations/catalogue.hh"

namespace mw::mailbox {
namespace {

using namespace messages;

constexpr int INDICES = 16;  ///< numbers of joints and axes that their fields permit

std::vector<Command> all_stops() {
    std::vector<Command> all{SetState{State::ESTOP}, SetState{State::OFF}, AbortAll{}, PauseProgram{}};
    for (int i = 0; i < INDICES; ++i) {
        all.emplace_back(JogStop{true, i});
        all.emplace_back(JogStop{false, i});
    }
    return all;
}

}  // namespace

bool isStop(const Command &command) {
    if (const auto *state = std::get_if<SetState>(&command)) {
        return state->state == State::ESTOP || state->state == State::OFF;
    }
    return std::visit([]<class C>(const C &) { return OneOf<C, AbortAll, JogStop, PauseProgram>; }, command);
}

std::optional<int> stop_place(const Command &command) {
    if (!isStop(command)) {
        return std::nullopt;
    }
    const auto all = all_stops();
    const std::string bytes = encode(command);
    const auto found =
        std::find_if(all.begin(), all.end(), [&](const Command &stop) { return encode(stop) == bytes; });
    return found == all.end() ? std::nullopt : std::optional(static_cast<int>(found - all.begin()));
}

Command stop_at(int place) {
    return all_stops()[static_cast<std::size_t>(place)];
}

}  // namespace mw::mailbox

// SPDX-License-Identifier: GPL-2.0-or-later
#include "clients/nml/net/jog_owners.hh"

namespace mw::nml {

void JogOwners::note(const void *connection, const messages::Command &command) {
    const std::lock_guard lock(mutex_);
    if (const auto *jog = std::get_if<messages::JogContinuous>(&command)) {
        owners_[{jog->isJoint, jog->index}] = connection;
    } else if (const auto *stop = std::get_if<messages::JogStop>(&command)) {
        owners_.erase({stop->isJoint, stop->index});
    } else if (const auto *step = std::get_if<messages::JogIncrement>(&command)) {
        owners_.erase({step->isJoint, step->index});
    } else if (const auto *absolute = std::get_if<messages::JogAbsolute>(&command)) {
        owners_.erase({absolute->isJoint, absolute->index});
    } else if (std::holds_alternative<messages::AbortAll>(command)) {
        owners_.clear();
    }
}

void JogOwners::leave(const void *connection) {
    const std::lock_guard lock(mutex_);
    for (auto owner = owners_.begin(); owner != owners_.end();) {
        if (owner->second == connection) {
            left_.emplace_back(messages::JogStop{owner->first.first, owner->first.second});
            owner = owners_.erase(owner);
        } else {
            ++owner;
        }
    }
}

std::vector<messages::Command> JogOwners::take() {
    const std::lock_guard lock(mutex_);
    return std::exchange(left_, {});
}

}  // namespace mw::nml

// SPDX-License-Identifier: GPL-2.0-or-later
#include "machine/task/states/inbox.hh"

#include <algorithm>

#include "base/overloaded.hh"
#include "messages/mailbox/stops.hh"

namespace mw::task {
namespace {

/// A pause of a paused program. While the mode changes nothing runs, and waiting commands are executed before
/// the pause.
bool isHold(const messages::Command &command) {
    return std::holds_alternative<messages::PauseProgram>(command);
}

/// On, off and emergency stop: a change of mode must not delay them.
bool isOfMachineState(const messages::Command &command) {
    return std::holds_alternative<messages::SetState>(command);
}

/// Commands that do not wait for a change of mode or state.
bool isUrgent(const messages::Command &command) {
    return (mailbox::isStop(command) && !isHold(command)) || isOfMachineState(command);
}

/// True for a jog of the joint or axis of `stop`.
bool isJogOf(const messages::JogStop &stop, const messages::Command &command) {
    return std::visit(
        [&]<class C>(const C &jog) {
            if constexpr (OneOf<C, messages::JogContinuous, messages::JogIncrement, messages::JogAbsolute>) {
                return jog.isJoint == stop.isJoint && jog.index == stop.index;
            } else if constexpr (OneOf<C, messages::SetTeleopVector>) {
                return !stop.isJoint && jog.velocity[stop.index] != 0.0;
            } else {
                return false;
            }
        },
        command);
}

}  // namespace

void Inbox::add(std::vector<mailbox::CommandServer::Delivery> deliveries) {
    std::move(deliveries.begin(), deliveries.end(), std::back_inserter(waiting_));
}

std::optional<mailbox::CommandServer::Delivery> Inbox::next(bool changing) {
    return next_of([&](const messages::Command &command) { return !changing || isUrgent(command); });
}

std::optional<mailbox::CommandServer::Delivery>
Inbox::next_of(const std::function<bool(const messages::Command &)> &isWanted) {
    const auto found = std::find_if(waiting_.begin(), waiting_.end(),
                                    [&](const auto &delivery) { return isWanted(delivery.command); });
    if (found == waiting_.end()) {
        return std::nullopt;
    }
    std::optional<mailbox::CommandServer::Delivery> taken = std::move(*found);
    waiting_.erase(found);
    return taken;
}

template <class Predicate>
std::vector<mailbox::Serial> Inbox::drop(const Predicate &isOver) {
    std::vector<mailbox::Serial> dropped;
    std::erase_if(waiting_, [&](const mailbox::CommandServer::Delivery &delivery) {
        const bool over = isOver(delivery);
        if (over) {
            dropped.push_back(delivery.serial);
        }
        return over;
    });
    return dropped;
}

std::vector<mailbox::Serial> Inbox::drop_before(mailbox::Serial stop) {
    return drop([&](const mailbox::CommandServer::Delivery &delivery) {
        const bool is_line = std::visit(
            []<class C>(const C &) {
                return OneOf<C, messages::OperatorError, messages::OperatorText, messages::OperatorDisplay>;
            },
            delivery.command);
        return delivery.serial < stop && !is_line;
    });
}

std::vector<mailbox::Serial> Inbox::drop_jogs_before(mailbox::Serial stop, const messages::JogStop &command) {
    return drop([&](const mailbox::CommandServer::Delivery &delivery) {
        return delivery.serial < stop && isJogOf(command, delivery.command);
    });
}

}  // namespace mw::task

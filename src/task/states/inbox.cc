// SPDX-License-Identifier: GPL-2.0-or-later
#include "task/states/inbox.hh"

#include <algorithm>

#include "mailbox/stops.hh"

namespace mw::task {
namespace {

bool isUrgent(const msgs::Command &command) {
    return mailbox::isStop(command) || std::holds_alternative<msgs::SetState>(command) ||
           std::holds_alternative<msgs::EstopOff>(command) ||
           std::holds_alternative<msgs::EstopReset>(command);
}

}  // namespace

void Inbox::add(std::vector<mailbox::Desk::Delivery> deliveries) {
    std::move(deliveries.begin(), deliveries.end(), std::back_inserter(waiting_));
}

std::optional<mailbox::Desk::Delivery> Inbox::next(bool isModeChanging) {
    const auto found = std::find_if(waiting_.begin(), waiting_.end(), [&](const auto &delivery) {
        return !isModeChanging || isUrgent(delivery.command);
    });
    if (found == waiting_.end()) {
        return std::nullopt;
    }
    std::optional<mailbox::Desk::Delivery> taken = std::move(*found);
    waiting_.erase(found);
    return taken;
}

std::vector<mailbox::Serial> Inbox::drop_before(mailbox::Serial stop) {
    std::vector<mailbox::Serial> dropped;
    std::erase_if(waiting_, [&](const mailbox::Desk::Delivery &delivery) {
        const bool isLine = std::holds_alternative<msgs::OperatorError>(delivery.command) ||
                            std::holds_alternative<msgs::OperatorText>(delivery.command) ||
                            std::holds_alternative<msgs::OperatorDisplay>(delivery.command);
        const bool isDropped = delivery.serial < stop && !isLine;
        if (isDropped) {
            dropped.push_back(delivery.serial);
        }
        return isDropped;
    });
    return dropped;
}

}  // namespace mw::task

// SPDX-License-Identifier: GPL-2.0-or-later
#include "machine/task/control/machine_port.hh"

namespace mw::task {

MotionLink::News MachinePort::update() {
    MotionLink::News news = link_.update();
    if (link_.watch().step(motion().cycle, now_ns_)) {
        post_error("motion (millwright-rt) has not responded for 0.25 s: stops are "
                   "not executed. Use the emergency stop switch of the machine");
    }
    return news;
}

Result<Progress> MachinePort::settle(mailbox::Serial command) {
    // Maximum time until clients receive the answer, including the period of a server between them.
    constexpr std::int64_t ANSWERED_WITHIN_NS = 60000000;
    const motion::CommandId order = link_.open_order();
    if (!link_.watch().isSilent() || order == 0) {
        return Progress::DONE;
    }
    orders_.begin(command, order, RefusalIsFor::EVERYBODY, now_ns_, ANSWERED_WITHIN_NS);
    return Progress::STARTED;
}

bool MachinePort::refuse_order(motion::CommandId order, const std::string &reason) {
    const auto refused = orders_.refuse(order, reason);
    if (refused.has_value()) {
        tell(refused->ending);
    }
    return !refused.has_value() || refused->reader == RefusalIsFor::EVERYBODY;
}

void MachinePort::end_orders() {
    const auto answered = [this](motion::CommandId order) { return isAnswered(order); };
    while (const auto ended = orders_.next(answered, now_ns_)) {
        if (ended->progress == Progress::FAILED) {
            post_error(ended->reason);  // Python clients do not receive the reason with the outcome
        }
        tell(ended);
    }
}

}  // namespace mw::task

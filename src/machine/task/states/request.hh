// SPDX-License-Identifier: GPL-2.0-or-later
// One command of the operator, from its start to its result.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <utility>

#include "machine/task/command.hh"
#include "messages/mailbox/segment.hh"
#include "motion/interface/command.hh"

namespace mw::task {

/// Outcome of a command, for the client that sent it.
struct Ending {
    mailbox::Serial command = 0;
    Progress progress = Progress::DONE;
    std::string reason;  ///< of a rejection or failure
};

/// At most one command at a time. All calls come from one thread.
class Request {
  public:
    static constexpr std::int64_t NO_DEADLINE = std::numeric_limits<std::int64_t>::max();

    void begin(mailbox::Serial command, std::int64_t deadline_ns = NO_DEADLINE) {
        command_ = command;
        deadline_ns_ = deadline_ns;
        order_ = 0;
    }
    void set_deadline(std::int64_t deadline_ns) { deadline_ns_ = deadline_ns; }
    /// Sets the command that was sent to motion for it.
    void set_order(motion::CommandId order) { order_ = order; }
    motion::CommandId order() const { return order_; }

    bool isUnderWay() const { return command_ != 0; }
    bool isLate(std::int64_t now_ns) const { return isUnderWay() && now_ns > deadline_ns_; }

    /// Ends the command; nothing if none is active.
    std::optional<Ending> end(Progress progress, std::string reason = {}) {
        if (!isUnderWay()) {
            return std::nullopt;
        }
        return Ending{std::exchange(command_, 0), progress, std::move(reason)};
    }
    /// Called when motion has rejected `order`; nothing if it does not belong to this command.
    std::optional<Ending> refuse(motion::CommandId order, const std::string &reason) {
        return order_ != 0 && order == order_ ? end(Progress::REFUSED, reason) : std::nullopt;
    }

  private:
    mailbox::Serial command_ = 0;
    std::int64_t deadline_ns_ = NO_DEADLINE;
    motion::CommandId order_ = 0;
};

/// Timeout of a change of state or mode.
inline constexpr std::int64_t CHANGE_TIMEOUT_NS = 2000000000;

}  // namespace mw::task

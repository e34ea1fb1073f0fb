// SPDX-License-Identifier: GPL-2.0-or-later
// Commands that end with the answer of motion.
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <string>

#include "machine/task/states/request.hh"
#include "motion/interface/command.hh"

namespace mw::task {

/// Receiver of the reason why motion has rejected a command.
enum class RefusalIsFor : std::uint8_t { EVERYBODY, ITS_CLIENT };

/// Keeps the commands sent to motion, in order, until they are answered. Their number is not limited. All
/// calls come from one thread.
class MotionOrders {
  public:
    void begin(mailbox::Serial command, motion::CommandId order, RefusalIsFor reader, std::int64_t now_ns,
               std::int64_t timeout_ns = CHANGE_TIMEOUT_NS) {
        waiting_.push_back({command, order, reader, now_ns + timeout_ns});
    }
    /// Called when motion has rejected `order`; nothing if it is not one of these commands.
    struct Refused {
        Ending ending;
        RefusalIsFor reader = RefusalIsFor::EVERYBODY;
    };
    std::optional<Refused> refuse(motion::CommandId order, const std::string &reason) {
        for (auto at = waiting_.begin(); at != waiting_.end(); ++at) {
            if (at->order == order) {
                const Refused refused{{at->command, Progress::REFUSED, reason}, at->reader};
                waiting_.erase(at);
                return refused;
            }
        }
        return std::nullopt;
    }
    /// The oldest command that motion has done, or has not answered in time. Call it until it returns
    /// nothing. `isAnswered` returns whether a command has been answered.
    template <class Predicate>
    std::optional<Ending> next(const Predicate &isAnswered, std::int64_t now_ns) {
        for (auto at = waiting_.begin(); at != waiting_.end(); ++at) {
            const bool is_done = isAnswered(at->order);
            if (is_done || now_ns > at->deadline_ns) {
                const Ending done{at->command, Progress::DONE, {}};
                const Ending late{at->command, Progress::FAILED,
                                  "the motion controller does not answer: does millwright-rt run?"};
                waiting_.erase(at);
                return is_done ? done : late;
            }
        }
        return std::nullopt;
    }

  private:
    struct Waiting {
        mailbox::Serial command;
        motion::CommandId order;
        RefusalIsFor reader;
        std::int64_t deadline_ns;
    };
    std::deque<Waiting> waiting_;
};

}  // namespace mw::task

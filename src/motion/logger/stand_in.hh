// SPDX-License-Identifier: GPL-2.0-or-later
// A motion controller for tests of task. It executes every command at once, without motion, and logs it.
#pragma once

#include <functional>
#include <string>

#include "motion/interface/channels.hh"
#include "motion/logger/log_text.hh"

namespace mw::motion {

/// One thread.
class StandIn {
  public:
    using Say = std::function<void(const std::string &)>;
    /// `channels` must be new and outlive the object.
    StandIn(Channels &channels, Say say);

    /// Answers waiting commands in order, and publishes the state after them.
    void step(std::int64_t time_ns);
    bool isInPosition() const { return status_.isInPosition; }

  private:
    void take(const Command &command);
    void take(const PathCommand &command);
    void publish(std::int64_t time_ns);

    Channels &channels_;
    Say say_;
    LogText text_;
    Status status_;
};

}  // namespace mw::motion

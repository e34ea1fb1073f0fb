// SPDX-License-Identifier: GPL-2.0-or-later
// Which connection jogs what, so that a jog ends when its connection does.
#pragma once

#include <map>
#include <mutex>
#include <utility>
#include <vector>

#include "messages/declarations/command.hh"

namespace mw::nml {

/// Continuous jogs of all connections of a server. Any thread.
class JogOwners {
  public:
    /// `connection` has sent the command; one that is no jog changes nothing.
    void note(const void *connection, const messages::Command &command);
    /// The connection has ended.
    void leave(const void *connection);
    /// What is to be stopped since the last call, because its connection has ended.
    std::vector<messages::Command> take();

  private:
    using Target = std::pair<bool, int>;  ///< joint or axis, and its number
    std::mutex mutex_;
    std::map<Target, const void *> owners_;
    std::vector<messages::Command> left_;
};

}  // namespace mw::nml

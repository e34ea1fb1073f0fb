// SPDX-License-Identifier: GPL-2.0-or-later
// Stores which connection jogs which joint or axis, so that a jog ends with its connection.
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
    /// Called when `connection` has sent the command; other commands than jogs have no effect.
    void note(const void *connection, const messages::Command &command);
    /// Called when the connection has ended.
    void leave(const void *connection);
    /// Stops for jogs whose connection has ended since the last call.
    std::vector<messages::Command> take();

  private:
    using Target = std::pair<bool, int>;  ///< joint or axis, and its number
    std::mutex mutex_;
    std::map<Target, const void *> owners_;
    std::vector<messages::Command> left_;
};

}  // namespace mw::nml

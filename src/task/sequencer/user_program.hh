// SPDX-License-Identifier: GPL-2.0-or-later
// The program of a user M code, M100 to M199, running beside task.
#pragma once

#include <string>

#include "base/result.hh"

namespace mw::task {

/// One program at a time, in a process group of its own. One thread; nothing blocks unless said.
class UserProgram {
  public:
    /// `isBlocking`: isRunning() waits for the program's end, for clocks that can stand still meanwhile.
    explicit UserProgram(bool isBlocking) : isBlocking_(isBlocking) {}
    ~UserProgram() { stop(); }
    UserProgram(const UserProgram &) = delete;
    UserProgram &operator=(const UserProgram &) = delete;

    /// Runs `path` with the words P and Q as its two arguments, -1 for one that was not given.
    Result<> start(const std::string &path, double p, double q);
    bool isRunning();
    /// How the last program ended, once: an error when it did not end with status 0.
    Result<> take_result();
    /// Ends it, and what it has started, at once.
    void stop();

  private:
    bool isBlocking_;
    int pid_ = 0;  ///< 0: none
    std::string path_;
    Result<> result_;
};

}  // namespace mw::task

// SPDX-License-Identifier: GPL-2.0-or-later
// The program of a user M code, M100 to M199, which runs in parallel with task.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/result.hh"

namespace mw::task {

/// Runs one program at a time, in a separate process group. One thread calls the methods. A method blocks
/// only if its comment states this.
class UserProgram {
  public:
    enum class Waits : std::uint8_t {
        NEVER,  ///< a separate thread finds and starts the program, because its disk may not answer
        /// start() waits for the disk and isRunning() for the end of the program; for clocks that can be
        /// stopped in this time
        IN_CALL,
    };
    explicit UserProgram(Waits waits) : waits_(waits) {}
    ~UserProgram() { stop(); }
    UserProgram(const UserProgram &) = delete;
    UserProgram &operator=(const UserProgram &) = delete;

    /// The path of a program. May block, and is not called by task's thread with Waits::NEVER.
    using Find = std::function<Result<std::string>()>;
    /// Runs the program that `find` returns with P and Q as its two arguments, -1 for a missing one. A
    /// failure is reported as the result of the program. `name`: for messages.
    void start(const std::string &name, Find find, double p, double q);
    bool isRunning();
    /// Result of the last program, returned once: an error if its status was not 0.
    Result<> take_result();
    /// Ends the program and its children at once. A program that has not started yet is not started, or is
    /// ended by the thread that starts it.
    void stop();
    /// Message that the program has not started within 1 s; returned once. Call it in each cycle at clock
    /// time `now_ns`.
    std::optional<std::string> take_delay(std::int64_t now_ns);

  private:
    struct Start;
    void take_start();
    void reap();

    Waits waits_;
    std::string name_;
    std::shared_ptr<Start> start_;  ///< the current start, shared with its thread
    std::optional<std::int64_t> start_since_ns_;
    bool delay_reported_ = false;
    int pid_ = 0;             ///< 0: none
    std::vector<int> ended_;  ///< killed processes that the kernel has not ended yet
    std::string path_;
    Result<> result_;
};

}  // namespace mw::task

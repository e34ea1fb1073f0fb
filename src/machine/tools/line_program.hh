// SPDX-License-Identifier: GPL-2.0-or-later
// A program that communicates in lines through its standard input and output.
#pragma once

#include <sys/types.h>

#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "base/result.hh"

namespace mw::machine {

/// The destructor closes the program's input, then requests its end, then kills it. Not realtime; one thread.
class LineProgram {
  public:
    /// `words`: the program, as a path from `folder` or a name in PATH, and its arguments. It runs in
    /// `folder` and shares our standard error.
    static Result<LineProgram> start(const std::vector<std::string> &words, const std::string &folder);
    LineProgram(LineProgram &&other) noexcept;
    LineProgram &operator=(LineProgram &&other) noexcept;
    ~LineProgram();

    const std::string &name() const { return name_; }
    /// Does not block. Text that the program does not accept at once waits. An error if the program has
    /// ended, or does not accept text for too long.
    Result<> write(const std::string &line);
    /// The next complete line without its end. Does not block.
    std::optional<std::string> read();
    /// Sleeps until a line arrives or `timeout_s` has passed.
    void sleep(double timeout_s) const;
    /// "it has ended with status 1"; nothing while it runs.
    std::optional<std::string> ending();

  private:
    LineProgram() = default;
    void flush();
    void take_bytes();
    void end() noexcept;

    std::string name_;
    pid_t pid_ = 0;  ///< 0: the program has ended
    std::string ending_;
    int in_ = -1, out_ = -1;  ///< its input and output
    std::string unsent_, received_;
};

}  // namespace mw::machine

// SPDX-License-Identifier: GPL-2.0-or-later
// A program that is spoken to in lines: its input and output are ours.
#pragma once

#include <sys/types.h>

#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "base/result.hh"

namespace mw::machine {

/// Ends with its object: its input is closed, then it is asked, then killed. Not realtime; one thread.
class LineProgram {
  public:
    /// `words`: the program, by its path from `folder` or found in PATH, and its arguments. It runs in
    /// `folder`; what it writes to stderr goes where ours goes.
    static Result<LineProgram> start(const std::vector<std::string> &words, const std::string &folder);
    LineProgram(LineProgram &&other) noexcept;
    LineProgram &operator=(LineProgram &&other) noexcept;
    ~LineProgram();

    const std::string &name() const { return name_; }
    /// Never blocks: what the program does not take at once waits; an error when it has ended, or takes
    /// nothing for too long.
    Result<> write(const std::string &line);
    /// A whole line that has come, without its end. Never blocks.
    std::optional<std::string> read();
    /// Sleeps until something comes or `timeout_s` is over.
    void sleep(double timeout_s) const;
    /// "it has ended with status 1"; nothing while it runs.
    std::optional<std::string> ending();

  private:
    LineProgram() = default;
    void flush();
    void take_bytes();
    void end() noexcept;

    std::string name_;
    pid_t pid_ = 0;  ///< 0: ended
    std::string ending_;
    int in_ = -1, out_ = -1;  ///< its input and output
    std::string unsent_, received_;
};

}  // namespace mw::machine

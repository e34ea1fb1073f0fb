// SPDX-License-Identifier: GPL-2.0-or-later
// Lines out of the bytes of a connection.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace mw::rsh {

/// Longest line that is read. [bytes]
inline constexpr std::size_t MAX_LINE = 4096;

/// One thread. Lines end with any of CR, LF and NUL; empty ones count for nothing.
class LineInput {
  public:
    struct Line {
        std::string text;
        bool isTooLong = false;  ///< of which nothing is kept but that it was
    };

    void take(std::string_view bytes) { input_ += bytes; }
    /// What is left is a line.
    void end() { isOver_ = true; }
    std::optional<Line> next();

    std::size_t waiting() const { return input_.size(); }
    bool isOver() const { return isOver_; }

  private:
    std::string input_;
    bool line_too_long_ = false, isOver_ = false;
};

}  // namespace mw::rsh

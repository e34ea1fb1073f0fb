// SPDX-License-Identifier: GPL-2.0-or-later
// Splits the bytes of a connection into lines.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace mw::rsh {

/// Maximum length of a line. [bytes]
inline constexpr std::size_t MAX_LINE = 4096;

/// All calls come from one thread. Lines end with CR, LF or NUL; empty lines are ignored.
class LineInput {
  public:
    struct Line {
        std::string text;
        bool isTooLong = false;  ///< the line was too long, and its content is discarded
    };

    void take(std::string_view bytes) { input_ += bytes; }
    /// The remaining bytes are a line.
    void end() { isOver_ = true; }
    std::optional<Line> next();

    std::size_t waiting() const { return input_.size(); }
    bool isOver() const { return isOver_; }

  private:
    std::string input_;
    bool line_too_long_ = false, isOver_ = false;
};

}  // namespace mw::rsh

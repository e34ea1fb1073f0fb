// SPDX-License-Identifier: GPL-2.0-or-later
// Characters and numbers of one line. Blanks outside comments and case are ignored.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace mw::gcode::detail {

/// A name in lower case without blanks, except the text in _hal[...]: HAL names keep their case.
std::string folded_name(std::string_view text);

class Lexer {
  public:
    explicit Lexer(std::string_view line) : line_(line) {}

    /// The next character that is not blank, in lower case; 0 at the end. Skips only blanks.
    char peek() {
        for (; pos_ < line_.size(); ++pos_) {
            if (!isBlank(line_[pos_])) {
                return lower(line_[pos_]);
            }
        }
        return '\0';
    }
    /// Skips the character that peek() returned.
    void take() { ++pos_; }
    /// Skips `c` if it is next.
    bool accept(char c) {
        if (peek() != c) {
            return false;
        }
        take();
        return true;
    }
    /// True for the first character of an unsigned number.
    static constexpr bool beginsNumber(char c) { return isDigit(c) || c == '.'; }
    /// Skips a word of letters if it is next (blanks allowed inside), else nothing.
    bool accept_word(std::string_view word);

    enum class Number { OK, NONE, BAD };
    /// Reads an unsigned decimal number. BAD: dots without a digit, or too large.
    Number take_number(double &value);
    /// The text from `start` to the current position, without blanks.
    std::string text_from(std::size_t start) const;
    /// Reads up to and including `closer`, as by folded_name. Nothing when there is none.
    std::optional<std::string> take_name(char closer);

    std::uint32_t column() const { return static_cast<std::uint32_t>(pos_) + 1; }
    std::size_t position() const { return pos_; }
    void set_position(std::size_t pos) { pos_ = pos; }
    std::string_view line() const { return line_; }

    static constexpr bool isBlank(char c) { return c <= ' ' && (c == ' ' || c == '\t' || c == '\r'); }
    static constexpr bool isDigit(char c) { return c >= '0' && c <= '9'; }
    static constexpr char lower(char c) {
        return (c >= 'A' && c <= 'Z') ? static_cast<char>(c - 'A' + 'a') : c;
    }

  private:
    Number take_odd_number(double &value);

    std::string_view line_;
    std::size_t pos_ = 0;
};

}  // namespace mw::gcode::detail

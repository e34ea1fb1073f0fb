// SPDX-License-Identifier: GPL-2.0-or-later
// Scans the declarations of a .comp file. The meaning of a word depends on its position (a HAL name has
// dashes and dots, a condition is C), so the parser requests the expected token.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "base/result.hh"

namespace mw::halcompile {

class Scanner {
  public:
    /// `text` must outlive the scanner; `file` is the name for positions.
    Scanner(std::string_view text, std::string file) : text_(text), file_(std::move(file)) {}

    /// Skips blanks and comments. False when a comment has no end.
    bool skip_blank();
    bool isAtEnd() const { return position_ >= text_.size(); }
    SourcePlace place() const { return {file_, line_, column_}; }
    std::size_t offset() const { return position_; }
    int line() const { return line_; }
    char peek(std::size_t ahead = 0) const {
        return position_ + ahead < text_.size() ? text_[position_ + ahead] : '\0';
    }
    bool isNext(std::string_view what) const { return text_.substr(position_).starts_with(what); }
    /// Skips `what` if it comes next.
    bool accept(std::string_view what);

    /// A C identifier; empty when there is none.
    std::string take_name();
    /// A C identifier that may contain dashes, dots and hash marks; empty when there is none.
    std::string take_hal_name();
    /// True when a string (of any kind) comes next.
    bool isAtString() const;
    /// A "double quoted", """triple quoted""" or r"raw" string with its escapes resolved.
    Result<std::string> take_string();
    /// C text up to one of `stops` or the word `stop_word`, both outside brackets, quotes and comments,
    /// trimmed. A stop '=' does not match ==, <=, >= or !=; a stop '"' ends before a string.
    Result<std::string> take_expression(std::string_view stops, std::string_view stop_word = {});
    /// True when the next C identifier is `word`.
    bool isWord(std::string_view word) const;
    /// The next text in braces, without them.
    Result<std::string> take_braced();
    /// The rest of the text up to `stop`, unchanged; nothing when the line ends before.
    std::optional<std::string> take_until(char stop);
    /// To continue after an error: skips the next ';' outside strings and comments, or stops before a line
    /// for which is_start returns true.
    void skip_declaration(bool (*is_start)(std::string_view line));

  private:
    void advance(std::size_t count = 1);
    bool skip_quoted();
    void take_escape(std::string &out);

    std::string_view text_;
    std::string file_;
    std::size_t position_ = 0;
    int line_ = 1;
    int column_ = 1;
};

}  // namespace mw::halcompile

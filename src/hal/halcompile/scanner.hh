// SPDX-License-Identifier: GPL-2.0-or-later
// Walks through the declarations of a .comp file. What a word is depends on where it stands (a HAL name has
// dashes and dots, a condition is C), so the parser asks for what it expects.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "base/result.hh"

namespace mw::halcompile {

class Scanner {
  public:
    /// `text` must outlive the scanner; `file` is what places name.
    Scanner(std::string_view text, std::string file) : text_(text), file_(std::move(file)) {}

    /// Passes blanks and comments. False when a comment has no end.
    bool skip_blank();
    bool isAtEnd() const { return position_ >= text_.size(); }
    SourcePlace place() const { return {file_, line_, column_}; }
    std::size_t offset() const { return position_; }
    int line() const { return line_; }
    char peek(std::size_t ahead = 0) const {
        return position_ + ahead < text_.size() ? text_[position_ + ahead] : '\0';
    }
    bool isNext(std::string_view what) const { return text_.substr(position_).starts_with(what); }
    /// Passes `what` if it comes next.
    bool accept(std::string_view what);

    /// A C identifier; empty when there is none.
    std::string take_name();
    /// A C identifier that may go on with dashes, dots and hash marks; empty when there is none.
    std::string take_hal_name();
    /// True when a string (of any kind) comes next.
    bool isAtString() const;
    /// A "double quoted", """triple quoted""" or r"raw" string with its escapes resolved.
    Result<std::string> take_string();
    /// C text up to one of `stops` or the word `stop_word`, both outside of brackets, quotes and comments,
    /// trimmed. A stop '=' is not a part of ==, <=, >= or !=; a stop '"' ends before a string.
    Result<std::string> take_expression(std::string_view stops, std::string_view stop_word = {});
    /// True when the C identifier that comes next is `word`.
    bool isWord(std::string_view word) const;
    /// The text between braces that comes next, without them.
    Result<std::string> take_braced();
    /// The rest of the text up to `stop`, taken as it is; nothing when the line ends before.
    std::optional<std::string> take_until(char stop);
    /// For going on after an error: passes the next ';' outside of strings and comments, or stops before a
    /// line for whose text isStart answers true.
    void skip_declaration(bool (*isStart)(std::string_view line));

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

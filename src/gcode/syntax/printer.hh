// SPDX-License-Identifier: GPL-2.0-or-later
// Prints the syntax tree as text, in one form for each meaning.
#pragma once

#include <string>
#include <string_view>

#include "gcode/syntax/ast.hh"

namespace mw::gcode::detail {

/// Prints parts of one line; names and comments are copied from the line.
class Printer {
  public:
    Printer(const Arena &arena, std::string_view line) : arena_(arena), line_(line) {}

    /// The whole block without indentation. Not for blocks with an error or a percent sign.
    std::string block(const Block &block) const;
    std::string word(const Word &word) const;
    std::string setting(const Setting &setting) const;
    std::string oword(const OWord &oword) const;
    /// The value after a letter, # or =: a number, #5, -#<a>, or [an expression].
    std::string value(NodeId node) const;
    /// The text inside brackets.
    std::string expression(NodeId node) const;
    std::string comments(const Block &block) const;

    static std::string number(double value);
    /// "sub", "endwhile"...; empty for a Fanuc-style O word.
    static std::string_view keyword(OKind kind);

  private:
    std::string operand(NodeId node, int lowest_level) const;
    std::string name_at(std::uint32_t column) const;

    const Arena &arena_;
    std::string_view line_;
};

/// Letters of words in upper case: "G", "X", "@".
char letter_text(int letter);

}  // namespace mw::gcode::detail

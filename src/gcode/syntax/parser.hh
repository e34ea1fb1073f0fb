// SPDX-License-Identifier: GPL-2.0-or-later
// Parses one line of RS-274/NGC into a Block in an Arena: one method per rule of the grammar.
#pragma once

#include <string>
#include <string_view>
#include <utility>

#include "gcode/syntax/ast.hh"
#include "gcode/syntax/expression_parser.hh"
#include "gcode/syntax/lexer.hh"
#include "gcode/syntax/names.hh"

namespace mw::gcode::detail {

/// A line with only a percent sign.
bool isPercentLine(std::string_view line);

class Parser {
  public:
    Parser(Arena &arena, Names &names) : arena_(arena), names_(names), values_(arena, names) {}

    /// Parses one line without its newline. A syntax error is kept in the block, which then has no other
    /// content.
    Block parse_line(std::string_view line, std::uint32_t number);

  private:
    // Each rule returns false after fail(), which sets the error of the line.
    bool block(Lexer &in, Block &out);
    bool line_number(Lexer &in, Block &out);
    bool item(Lexer &in, Block &out, char c);
    bool comment(Lexer &in, Block &out);
    bool setting(Lexer &in, Block &out);
    bool word(Lexer &in, Block &out, char c);
    bool oword(Lexer &in, Block &out);
    bool oword_label(Lexer &in, OWord &out);
    bool oword_keyword(Lexer &in, OWord &out);
    bool oword_call(Lexer &in, Block &block, OWord &out);
    bool rest_of_oword(Lexer &in, Block &out);

    bool fail(std::string message, std::uint32_t column) { return values_.fail(std::move(message), column); }

    Arena &arena_;
    Names &names_;
    ExpressionParser values_;
    std::uint32_t letters_seen_ = 0;  ///< bit per letter of the line, except G and M
};

}  // namespace mw::gcode::detail

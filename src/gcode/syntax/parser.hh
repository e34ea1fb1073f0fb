// SPDX-License-Identifier: GPL-2.0-or-later
// Parses one line of RS-274/NGC into a Block in an Arena: one method per rule of the grammar.
#pragma once

#include <string>
#include <string_view>

#include "gcode/syntax/ast.hh"
#include "gcode/syntax/lexer.hh"
#include "gcode/syntax/names.hh"

namespace mw::gcode::detail {

/// A line with only a percent sign.
bool isPercentLine(std::string_view line);

class Parser {
  public:
    Parser(Arena &arena, Names &names) : arena_(arena), names_(names) {}

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

    bool real_value(Lexer &in, NodeId &out);
    bool signed_value(Lexer &in, NodeId &out);
    bool bad_number(const Lexer &in, std::size_t start);
    bool number(Lexer &in, NodeId &out);
    bool parameter(Lexer &in, NodeId &out);
    bool expression(Lexer &in, NodeId &out);
    bool binary(Lexer &in, int lowest_level, NodeId &out);
    bool binary_operator(Lexer &in, Operator &op, int &level);
    bool function(Lexer &in, NodeId &out);
    bool atan(Lexer &in, std::uint32_t column, NodeId &out);
    bool exists(Lexer &in, std::uint32_t column, NodeId &out);

    NodeId add(Node node, const Lexer &in);
    bool fail(std::string message, std::uint32_t column);

    Arena &arena_;
    Names &names_;
    std::string error_;
    std::uint32_t error_column_ = 0;
    int depth_ = 0;
    int operators_ = 0;               ///< number of binary operators in this line
    std::uint32_t letters_seen_ = 0;  ///< bit per letter of the line, except G and M
};

}  // namespace mw::gcode::detail

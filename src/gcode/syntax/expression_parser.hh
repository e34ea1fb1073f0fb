// SPDX-License-Identifier: GPL-2.0-or-later
// Parses the values of one line: numbers, parameters, expressions and functions. One method per rule.
#pragma once

#include <string>

#include "gcode/syntax/ast.hh"
#include "gcode/syntax/lexer.hh"
#include "gcode/syntax/names.hh"

namespace mw::gcode::detail {

/// Limits the nesting and the number of operators of a line, and keeps its last error.
class ExpressionParser {
  public:
    ExpressionParser(Arena &arena, Names &names) : arena_(arena), names_(names) {}

    void begin_line() { depth_ = operators_ = 0; }
    // Each rule returns false after fail(), which sets the error of the line.
    bool real_value(Lexer &in, NodeId &out);
    /// take_number() has failed at the position `start` or after blanks there.
    bool bad_number(const Lexer &in, std::size_t start);

    bool fail(std::string message, std::uint32_t column);
    const std::string &error() const { return error_; }
    std::uint32_t error_column() const { return error_column_; }

  private:
    bool signed_value(Lexer &in, NodeId &out);
    bool number(Lexer &in, NodeId &out);
    bool parameter(Lexer &in, NodeId &out);
    bool expression(Lexer &in, NodeId &out);
    bool binary(Lexer &in, int lowest_level, NodeId &out);
    bool binary_operator(Lexer &in, Operator &op, int &level);
    bool function(Lexer &in, NodeId &out);
    bool atan(Lexer &in, std::uint32_t column, NodeId &out);
    bool exists(Lexer &in, std::uint32_t column, NodeId &out);

    NodeId add(Node node, const Lexer &in);

    Arena &arena_;
    Names &names_;
    std::string error_;
    std::uint32_t error_column_ = 0;
    int depth_ = 0;
    int operators_ = 0;  ///< number of binary operators in this line
};

}  // namespace mw::gcode::detail

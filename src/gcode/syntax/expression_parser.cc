// SPDX-License-Identifier: GPL-2.0-or-later
#include "gcode/syntax/expression_parser.hh"

#include <array>

#include <fmt/format.h>

namespace mw::gcode::detail {
namespace {

constexpr int MAX_DEPTH = 128;  // maximum nesting of brackets, signs and #
/// 1+1+1... nests as deep as its number of operators, and evaluation needs stack for each.
constexpr int MAX_OPERATORS = 1000;

struct FunctionName {
    std::string_view text;
    Function function;
};

constexpr std::array FUNCTIONS{
    FunctionName{"abs", Function::ABS},     FunctionName{"acos", Function::ACOS},
    FunctionName{"asin", Function::ASIN},   FunctionName{"cos", Function::COS},
    FunctionName{"exp", Function::EXP},     FunctionName{"fix", Function::FIX},
    FunctionName{"fup", Function::FUP},     FunctionName{"ln", Function::LN},
    FunctionName{"round", Function::ROUND}, FunctionName{"sin", Function::SIN},
    FunctionName{"sqrt", Function::SQRT},   FunctionName{"tan", Function::TAN},
};

struct OperatorName {
    std::string_view text;
    Operator op;
    int level;  ///< higher binds stronger
};

constexpr int LOWEST_LEVEL = 1, HIGHEST_LEVEL = 5;
constexpr std::array OPERATORS{
    OperatorName{"**", Operator::POWER, 5}, OperatorName{"*", Operator::TIMES, 4},
    OperatorName{"/", Operator::DIVIDE, 4}, OperatorName{"mod", Operator::MODULO, 4},
    OperatorName{"+", Operator::PLUS, 3},   OperatorName{"-", Operator::MINUS, 3},
    OperatorName{"eq", Operator::EQ, 2},    OperatorName{"ne", Operator::NE, 2},
    OperatorName{"gt", Operator::GT, 2},    OperatorName{"ge", Operator::GE, 2},
    OperatorName{"lt", Operator::LT, 2},    OperatorName{"le", Operator::LE, 2},
    OperatorName{"and", Operator::AND, 1},  OperatorName{"or", Operator::OR, 1},
    OperatorName{"xor", Operator::XOR, 1},
};

class DepthGuard {
  public:
    explicit DepthGuard(int &depth) : depth_(depth) { ++depth_; }
    ~DepthGuard() { --depth_; }
    DepthGuard(const DepthGuard &) = delete;
    DepthGuard &operator=(const DepthGuard &) = delete;
    bool isTooDeep() const { return depth_ > MAX_DEPTH; }

  private:
    int &depth_;
};

}  // namespace

bool ExpressionParser::fail(std::string message, std::uint32_t column) {
    error_ = std::move(message);
    error_column_ = column;
    return false;
}

NodeId ExpressionParser::add(Node node, const Lexer &in) {
    node.end_column = in.column();
    arena_.nodes.push_back(node);
    return static_cast<NodeId>(arena_.nodes.size() - 1);
}

/// [expression], #parameter, a sign before any value, a function, or a number.
bool ExpressionParser::real_value(Lexer &in, NodeId &out) {
    const DepthGuard guard(depth_);
    if (guard.isTooDeep()) {
        return fail("The expression is nested too deeply", in.column());
    }
    const char c = in.peek();
    if (c == '[') {
        in.take();
        return expression(in, out);
    }
    if (c == '#') {
        return parameter(in, out);
    }
    if (c == '-' || c == '+') {
        return signed_value(in, out);
    }
    if (c >= 'a' && c <= 'z') {
        return function(in, out);
    }
    return number(in, out);
}

bool ExpressionParser::signed_value(Lexer &in, NodeId &out) {
    const std::uint32_t column = in.column();
    const bool negative = in.peek() == '-';
    in.take();
    NodeId inner = NO_ID;
    if (!real_value(in, inner)) {
        return false;
    }
    out = inner;
    if (negative && arena_.nodes[inner].kind == NodeKind::NUMBER) {
        arena_.nodes[inner].value = -arena_.nodes[inner].value;
        arena_.nodes[inner].column = column;
    } else if (negative) {
        out = add({.kind = NodeKind::NEGATE, .column = column, .a = inner}, in);
    }
    return true;
}

bool ExpressionParser::bad_number(const Lexer &in, std::size_t start) {
    return fail(fmt::format("bad number format (conversion failed) parsing '{}'", in.text_from(start)),
                static_cast<std::uint32_t>(start) + 1);
}

bool ExpressionParser::number(Lexer &in, NodeId &out) {
    Node node{.kind = NodeKind::NUMBER, .column = in.column()};
    const std::size_t start = in.position();
    if (in.take_number(node.value) != Lexer::Number::OK) {
        return bad_number(in, start);
    }
    out = add(node, in);
    return true;
}

bool ExpressionParser::parameter(Lexer &in, NodeId &out) {
    const std::uint32_t column = in.column();
    in.take();
    if (in.accept('<')) {
        const auto name = in.take_name('>');
        if (!name) {
            return fail("Named parameter not terminated", column);
        }
        out = add({.kind = NodeKind::NAMED, .column = column, .a = names_.intern(*name)}, in);
        return true;
    }
    NodeId index = NO_ID;
    if (!real_value(in, index)) {
        return false;
    }
    out = add({.kind = NodeKind::PARAMETER, .column = column, .a = index}, in);
    return true;
}

/// The opening bracket has been read; reads the closing one.
bool ExpressionParser::expression(Lexer &in, NodeId &out) {
    if (!binary(in, LOWEST_LEVEL, out)) {
        return false;
    }
    if (!in.accept(']')) {
        return fail(in.peek() == '\0' ? "Unclosed expression" : "Unknown operation", in.column());
    }
    return true;
}

bool ExpressionParser::binary_operator(Lexer &in, Operator &op, int &level) {
    const std::size_t start = in.position();
    for (const OperatorName &candidate : OPERATORS) {
        if (in.accept_word(candidate.text)) {
            op = candidate.op;
            level = candidate.level;
            return true;
        }
    }
    in.set_position(start);
    return false;
}

/// Operators of `lowest_level` and above, each level from left to right.
bool ExpressionParser::binary(Lexer &in, int lowest_level, NodeId &out) {
    if (lowest_level > HIGHEST_LEVEL) {
        return real_value(in, out);
    }
    if (!binary(in, lowest_level + 1, out)) {
        return false;
    }
    while (true) {
        const std::uint32_t column = (in.peek(), in.column());
        const std::size_t start = in.position();
        Operator op{};
        int level = 0;
        if (!binary_operator(in, op, level) || level != lowest_level) {
            in.set_position(start);
            return true;
        }
        if (++operators_ > MAX_OPERATORS) {
            return fail(
                fmt::format("A line has at most {} operators: divide it into several lines", MAX_OPERATORS),
                column);
        }
        NodeId right = NO_ID;
        if (!binary(in, lowest_level + 1, right)) {
            return false;
        }
        out = add({.kind = NodeKind::BINARY,
                   .op = static_cast<std::uint8_t>(op),
                   .column = column,
                   .a = out,
                   .b = right},
                  in);
    }
}

bool ExpressionParser::function(Lexer &in, NodeId &out) {
    const std::uint32_t column = in.column();
    const char first = in.peek();
    if (in.accept_word("atan")) {
        return atan(in, column, out);
    }
    if (in.accept_word("exists")) {
        return exists(in, column, out);
    }
    for (const FunctionName &candidate : FUNCTIONS) {
        if (!in.accept_word(candidate.text)) {
            continue;
        }
        if (!in.accept('[')) {
            return fail("Left bracket missing after unary operation name", in.column());
        }
        NodeId argument = NO_ID;
        if (!expression(in, argument)) {
            return false;
        }
        out = add({.kind = NodeKind::FUNCTION,
                   .op = static_cast<std::uint8_t>(candidate.function),
                   .column = column,
                   .a = argument},
                  in);
        return true;
    }
    return fail(fmt::format("Unknown word starting with {}", first), column);
}

bool ExpressionParser::atan(Lexer &in, std::uint32_t column, NodeId &out) {
    NodeId y = NO_ID, x = NO_ID;
    if (!in.accept('[')) {
        return fail("Left bracket missing after unary operation name", in.column());
    }
    if (!expression(in, y)) {
        return false;
    }
    if (!in.accept('/')) {
        return fail("Slash missing after first atan argument", in.column());
    }
    if (!in.accept('[')) {
        return fail("Left bracket missing after slash with atan", in.column());
    }
    if (!expression(in, x)) {
        return false;
    }
    out = add({.kind = NodeKind::ATAN, .column = column, .a = y, .b = x}, in);
    return true;
}

/// exists[#<name>] or exists[#number]: whether the parameter can be read.
bool ExpressionParser::exists(Lexer &in, std::uint32_t column, NodeId &out) {
    if (!in.accept('[')) {
        return fail("Expected [ after exists", in.column());
    }
    if (!in.accept('#')) {
        return fail("Expected # reading parameter", in.column());
    }
    Node node{.kind = NodeKind::EXISTS_NUMBER, .column = column};
    if (in.accept('<')) {
        const auto name = in.take_name('>');
        if (!name) {
            return fail("Named parameter not terminated", column);
        }
        node.kind = NodeKind::EXISTS_NAME;
        node.a = names_.intern(*name);
    } else if (!real_value(in, node.a)) {
        return false;
    }
    if (!in.accept(']')) {
        return fail("Expected ] reading bracketed parameter", in.column());
    }
    out = add(node, in);
    return true;
}

}  // namespace mw::gcode::detail

// SPDX-License-Identifier: GPL-2.0-or-later
#include "gcode/syntax/printer.hh"

#include <algorithm>
#include <array>
#include <charconv>
#include <vector>

#include "base/text.hh"

namespace mw::gcode::detail {
namespace {

struct OperatorText {
    std::string_view text;
    int level;  ///< higher binds stronger, as in the parser
};
/// In the order of Operator.
constexpr std::array<OperatorText, 15> OPERATORS{{{"**", 5},
                                                  {"*", 4},
                                                  {"/", 4},
                                                  {"MOD", 4},
                                                  {"+", 3},
                                                  {"-", 3},
                                                  {"EQ", 2},
                                                  {"NE", 2},
                                                  {"GT", 2},
                                                  {"GE", 2},
                                                  {"LT", 2},
                                                  {"LE", 2},
                                                  {"AND", 1},
                                                  {"OR", 1},
                                                  {"XOR", 1}}};
/// In the order of Function.
constexpr std::array<std::string_view, 12> FUNCTIONS{"ABS", "ACOS", "ASIN",  "COS", "EXP",  "FIX",
                                                     "FUP", "LN",   "ROUND", "SIN", "SQRT", "TAN"};
/// In the order of OKind.
constexpr std::array<std::string_view, 17> KEYWORDS{
    "",      "sub",      "endsub", "call",   "return",    "if",    "elseif",   "else", "endif",
    "while", "endwhile", "do",     "repeat", "endrepeat", "break", "continue", ""};

constexpr int MAX_LEVEL = 5;

const OperatorText &text_of(const Node &node) {
    return OPERATORS[node.op];
}

}  // namespace

char letter_text(int letter) {
    constexpr std::string_view LETTERS = "ABCDEFGHIJKLMNOPQRSTUVWXYZ@^$";
    return LETTERS[static_cast<std::size_t>(letter)];
}

std::string_view Printer::keyword(OKind kind) {
    return KEYWORDS[static_cast<std::size_t>(kind)];
}

/// G-code has no exponents.
std::string Printer::number(double value) {
    std::array<char, 400> buffer{};
    const auto end =
        std::to_chars(buffer.data(), buffer.data() + buffer.size(), value, std::chars_format::fixed);
    return {buffer.data(), end.ptr};
}

/// The text from < to > at or after a column.
std::string Printer::name_at(std::uint32_t column) const {
    const std::size_t begin = line_.find('<', column - 1);
    const std::size_t end = begin == std::string_view::npos ? begin : line_.find('>', begin);
    return end == std::string_view::npos ? std::string() : std::string(line_.substr(begin, end - begin + 1));
}

std::string Printer::operand(NodeId id, int lowest_level) const {
    const Node &node = arena_.nodes[id];
    if (node.kind == NodeKind::BINARY) {
        const std::string text = expression(id);
        return text_of(node).level >= lowest_level ? text : "[" + text + "]";
    }
    return expression(id);
}

std::string Printer::expression(NodeId id) const {
    const Node &node = arena_.nodes[id];
    switch (node.kind) {
    case NodeKind::NUMBER: return number(node.value);
    case NodeKind::PARAMETER: return "#" + value(node.a);
    case NodeKind::NAMED: return "#" + name_at(node.column);
    case NodeKind::NEGATE: return "-" + operand(node.a, MAX_LEVEL + 1);
    case NodeKind::FUNCTION: return std::string(FUNCTIONS[node.op]) + "[" + expression(node.a) + "]";
    case NodeKind::ATAN: return "ATAN[" + expression(node.a) + "]/[" + expression(node.b) + "]";
    case NodeKind::BINARY: {
        const OperatorText &op = text_of(node);
        return operand(node.a, op.level) + " " + std::string(op.text) + " " + operand(node.b, op.level + 1);
    }
    case NodeKind::EXISTS_NUMBER: return "EXISTS[#" + value(node.a) + "]";
    case NodeKind::EXISTS_NAME: return "EXISTS[#" + name_at(node.column) + "]";
    }
    return {};
}

std::string Printer::value(NodeId id) const {
    const Node &node = arena_.nodes[id];
    switch (node.kind) {
    case NodeKind::NUMBER:
    case NodeKind::PARAMETER:
    case NodeKind::NAMED: return expression(id);
    case NodeKind::NEGATE: return "-" + value(node.a);
    default: return "[" + expression(id) + "]";
    }
}

std::string Printer::word(const Word &word) const {
    return letter_text(word.letter) +
           (word.expression == NO_ID ? number(word.value) : value(word.expression));
}

std::string Printer::setting(const Setting &setting) const {
    const std::string left = setting.index == NO_ID ? name_at(setting.column) : value(setting.index);
    return "#" + left + " = " + value(setting.value);
}

std::string Printer::oword(const OWord &oword) const {
    std::string out = "o";
    if (oword.label == NO_ID) {
        out += value(oword.label_expression);
    } else {
        const std::string_view rest = trim(line_.substr(oword.column));
        if (!rest.empty() && rest[0] == '<') {
            out += name_at(oword.column);
        } else {
            // The number extends to the keyword or the comment, including blanks.
            std::string digits;
            for (const char c : rest) {
                if ((c >= '0' && c <= '9') || c == '.') {
                    digits += c;
                } else if (c != ' ' && c != '\t') {
                    break;
                }
            }
            out += digits.substr(0, digits.find('.'));
        }
    }
    if (oword.kind != OKind::FANUC) {
        out += " " + std::string(keyword(oword.kind));
    }
    for (std::uint32_t i = 0; i < oword.argument_count; ++i) {
        out += " [" + expression(arena_.arguments[oword.first_argument + i]) + "]";
    }
    if (oword.value != NO_ID) {
        out += " [" + expression(oword.value) + "]";
    }
    return out;
}

/// All comments, then the one to the end of the line.
std::string Printer::comments(const Block &block) const {
    std::string out;
    std::size_t at = 0;
    for (std::uint32_t i = 0; i < block.comment_count; ++i) {
        const Comment &comment = arena_.comments[block.first_comment + i];
        if (comment.begin > 0 && line_[comment.begin - 1] == '(') {
            out += (out.empty() ? "(" : " (") +
                   std::string(line_.substr(comment.begin, comment.end - comment.begin)) + ")";
            at = comment.end;
        }
    }
    for (bool inside = false; at < line_.size(); ++at) {
        if (line_[at] == '(' || line_[at] == ')') {
            inside = line_[at] == '(';
        } else if (line_[at] == ';' && !inside) {
            const std::string_view text = line_.substr(at);
            out += (out.empty() ? "" : " ") + std::string(text.substr(0, text.find_last_not_of(" \t\r") + 1));
            break;
        }
    }
    return out;
}

std::string Printer::block(const Block &block) const {
    std::string out = block.deletable ? "/" : "";
    const auto add = [&out](const std::string &part) {
        if (!out.empty() && out.back() != '/' && !part.empty()) {
            out += ' ';
        }
        out += part;
    };
    if (block.isNumbered) {
        add("N" + std::to_string(block.sequence));
    }
    if (block.oword != NO_ID) {
        add(oword(arena_.owords[block.oword]));
    }
    std::vector<std::pair<std::uint32_t, std::string>> parts;
    for (std::uint32_t i = 0; i < block.word_count; ++i) {
        const Word &one = arena_.words[block.first_word + i];
        parts.emplace_back(one.column, word(one));
    }
    for (std::uint32_t i = 0; i < block.setting_count; ++i) {
        const Setting &one = arena_.settings[block.first_setting + i];
        parts.emplace_back(one.column, setting(one));
    }
    std::sort(parts.begin(), parts.end());
    for (const auto &part : parts) {
        add(part.second);
    }
    add(comments(block));
    return out;
}

}  // namespace mw::gcode::detail

// SPDX-License-Identifier: GPL-2.0-or-later
// The syntax tree of a program: compact nodes in arenas, referred to by index. Every node has its column.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace mw::gcode::detail {

/// A call with more than 30 arguments makes the parameters from #31 on local to the subroutine.
inline constexpr std::size_t MAX_CALL_ARGUMENTS = 1000;
inline constexpr std::size_t MAX_LINE_LENGTH = 1000000;  // characters

using NodeId = std::uint32_t;
using NameId = std::uint32_t;
inline constexpr std::uint32_t NO_ID = 0xffffffffu;

enum class NodeKind : std::uint8_t {
    NUMBER,         // value
    PARAMETER,      // #a
    NAMED,          // #<name>, a is the NameId
    NEGATE,         // -a
    FUNCTION,       // op[a]
    ATAN,           // atan[a]/[b]
    BINARY,         // a op b
    EXISTS_NUMBER,  // exists[#a]
    EXISTS_NAME,    // exists[#<name>], a is the NameId
};

enum class Operator : std::uint8_t {
    POWER,
    TIMES,
    DIVIDE,
    MODULO,
    PLUS,
    MINUS,
    EQ,
    NE,
    GT,
    GE,
    LT,
    LE,
    AND,
    OR,
    XOR,
};

enum class Function : std::uint8_t { ABS, ACOS, ASIN, COS, EXP, FIX, FUP, LN, ROUND, SIN, SQRT, TAN };

struct Node {
    NodeKind kind = NodeKind::NUMBER;
    std::uint8_t op = 0;           ///< Operator or Function
    std::uint32_t column = 0;      ///< from 1
    std::uint32_t end_column = 0;  ///< one past the last character
    NodeId a = NO_ID, b = NO_ID;
    double value = 0;
};

/// Letters as indices: a..z are 0..25.
inline constexpr int LETTER_AT = 26, LETTER_CARET = 27, LETTER_DOLLAR = 28, LETTER_COUNT = 29;
constexpr int letter(char c) {
    return c - 'a';
}

/// A letter with its value; if `expression` is NO_ID, `value` is a constant.
struct Word {
    std::uint8_t letter = 0;
    std::uint32_t column = 0;
    NodeId expression = NO_ID;
    double value = 0;
};

/// #index = value or #<name> = value.
struct Setting {
    NodeId index = NO_ID;  ///< NO_ID for a name
    NameId name = NO_ID;
    NodeId value = NO_ID;
    std::uint32_t column = 0;
};

/// A comment's text lies in the line at [begin, end), counted from 0.
struct Comment {
    std::uint32_t begin = 0, end = 0;
    bool is_script = false;  ///< the statements of a line that begins with ;py,
};

enum class OKind : std::uint8_t {
    NONE,
    SUB,
    ENDSUB,
    CALL,
    RETURN,
    IF,
    ELSEIF,
    ELSE,
    ENDIF,
    WHILE,
    ENDWHILE,
    DO,
    REPEAT,
    ENDREPEAT,
    BREAK,
    CONTINUE,
    FANUC,  // O123 alone
};

struct OWord {
    OKind kind = OKind::NONE;
    std::uint32_t column = 0;
    NameId label = NO_ID;  ///< NO_ID when the label must be computed
    NodeId label_expression = NO_ID;
    NodeId value = NO_ID;                                  ///< condition, count or return value
    std::uint32_t first_argument = 0, argument_count = 0;  ///< in Arena::arguments
};

struct SyntaxError {
    std::string message;
    std::uint32_t column = 0;
};

/// One line, parsed.
struct Block {
    std::uint32_t line = 0;  ///< from 1
    std::uint32_t first_word = 0, first_setting = 0, first_comment = 0;
    std::uint16_t word_count = 0, setting_count = 0, comment_count = 0;
    bool deletable = false;  ///< begins with a slash
    bool is_percent = false;
    bool isNumbered = false;
    std::int32_t sequence = 0;    ///< N word
    std::uint32_t oword = NO_ID;  ///< in Arena::owords
    std::uint32_t error = NO_ID;  ///< in Arena::errors
};

struct Arena {
    std::vector<Node> nodes;
    std::vector<Word> words;
    std::vector<Setting> settings;
    std::vector<Comment> comments;
    std::vector<OWord> owords;
    std::vector<NodeId> arguments;
    std::vector<SyntaxError> errors;

    void clear() {
        nodes.clear();
        words.clear();
        settings.clear();
        comments.clear();
        owords.clear();
        arguments.clear();
        errors.clear();
    }
};

}  // namespace mw::gcode::detail

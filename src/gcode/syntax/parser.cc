// SPDX-License-Identifier: GPL-2.0-or-later
#include "gcode/syntax/parser.hh"

#include <array>

#include <fmt/format.h>

#include "gcode/syntax/odd_characters.hh"

namespace mw::gcode::detail {
namespace {

struct Keyword {
    std::string_view text;
    OKind kind;
};

// Longer words before their prefixes.
constexpr std::array KEYWORDS{
    Keyword{"sub", OKind::SUB},
    Keyword{"endsub", OKind::ENDSUB},
    Keyword{"call", OKind::CALL},
    Keyword{"return", OKind::RETURN},
    Keyword{"if", OKind::IF},
    Keyword{"elseif", OKind::ELSEIF},
    Keyword{"else", OKind::ELSE},
    Keyword{"endif", OKind::ENDIF},
    Keyword{"while", OKind::WHILE},
    Keyword{"endwhile", OKind::ENDWHILE},
    Keyword{"do", OKind::DO},
    Keyword{"repeat", OKind::REPEAT},
    Keyword{"endrepeat", OKind::ENDREPEAT},
    Keyword{"break", OKind::BREAK},
    Keyword{"continue", OKind::CONTINUE},
};

int index_of_letter(char c) {
    if (c >= 'a' && c <= 'z') {
        return letter(c);
    }
    return c == '@' ? LETTER_AT : (c == '^' ? LETTER_CARET : (c == '$' ? LETTER_DOLLAR : -1));
}

bool takesValue(OKind kind) {
    return kind == OKind::IF || kind == OKind::ELSEIF || kind == OKind::WHILE || kind == OKind::REPEAT;
}

}  // namespace

bool isPercentLine(std::string_view line) {
    const std::size_t first = line.find_first_not_of(" \t\r");
    return first != std::string_view::npos && line[first] == '%' &&
           line.find_first_not_of(" \t\r", first + 1) == std::string_view::npos;
}

Block Parser::parse_line(std::string_view line, std::uint32_t line_number_) {
    Block out;
    out.line = line_number_;
    out.first_word = static_cast<std::uint32_t>(arena_.words.size());
    out.first_setting = static_cast<std::uint32_t>(arena_.settings.size());
    out.first_comment = static_cast<std::uint32_t>(arena_.comments.size());
    letters_seen_ = 0;
    values_.begin_line();
    Lexer in(line);
    const bool too_long = line.size() > MAX_LINE_LENGTH;
    if (too_long) {
        fail(fmt::format("The line is longer than {} characters", MAX_LINE_LENGTH), 1);
    }
    const bool is_read = !too_long && block(in, out);
    if (!is_read && !too_long) {
        if (const auto odd = find_odd_character(line)) {
            fail(fmt::format("Bad character {} used", odd->name),
                 static_cast<std::uint32_t>(odd->position) + 1);
        }
    }
    if (!is_read) {
        out.error = static_cast<std::uint32_t>(arena_.errors.size());
        arena_.errors.push_back({values_.error(), values_.error_column()});
    }
    return out;
}

bool Parser::block(Lexer &in, Block &out) {
    if (in.accept('/')) {
        out.deletable = true;
    }
    char c = in.peek();
    if (c == '%' && !out.deletable && isPercentLine(in.line())) {
        out.is_percent = true;
        return true;
    }
    if (c == 'n') {
        if (!line_number(in, out)) {
            return false;
        }
        c = in.peek();
    }
    for (; c != '\0'; c = in.peek()) {
        if (!item(in, out, c)) {
            return false;
        }
    }
    return in.position() == in.line().size() || fail("Bad character used", in.column());
}

bool Parser::line_number(Lexer &in, Block &out) {
    const std::uint32_t column = in.column();
    in.take();
    double value = 0;
    if (in.take_number(value) != Lexer::Number::OK || value > 2147483647.0) {
        return fail("N needs a number that is not negative and at most 2147483647", column);
    }
    out.isNumbered = true;
    out.sequence = static_cast<std::int32_t>(value);
    return true;
}

/// `c` is the character that peek() returned.
bool Parser::item(Lexer &in, Block &out, char c) {
    switch (c) {
    case '(': return comment(in, out);
    case ';': return comment(in, out);
    case '#': return setting(in, out);
    case 'o': return oword(in, out);
    default: return word(in, out, c);
    }
}

/// ( to ) or ; to the end of the line. Only the last one of a line counts, but all are kept.
bool Parser::comment(Lexer &in, Block &out) {
    const std::uint32_t column = in.column();
    const std::string_view line = in.line();
    const bool ending = in.peek() == ';';
    const std::size_t begin = in.position() + 1;
    const std::size_t end = ending ? line.size() : line.find(')', begin);
    if (end == std::string_view::npos) {
        return fail("Unclosed comment found", column);
    }
    constexpr std::string_view SCRIPT = ";py,";
    if (ending && line.starts_with(SCRIPT)) {
        arena_.comments.push_back(
            {static_cast<std::uint32_t>(SCRIPT.size()), static_cast<std::uint32_t>(end), true});
        ++out.comment_count;
    }
    if (!ending) {
        if (line.substr(begin, end - begin).find('(') != std::string_view::npos) {
            return fail("Nested comment found", column);
        }
        arena_.comments.push_back({static_cast<std::uint32_t>(begin), static_cast<std::uint32_t>(end)});
        ++out.comment_count;
    }
    in.set_position(ending ? end : end + 1);
    return true;
}

bool Parser::setting(Lexer &in, Block &out) {
    Setting made;
    made.column = in.column();
    in.take();
    if (in.accept('<')) {
        const auto name = in.take_name('>');
        if (!name) {
            return fail("Named parameter not terminated", made.column);
        }
        made.name = names_.intern(*name);
    } else if (!values_.real_value(in, made.index)) {
        return false;
    }
    if (!in.accept('=')) {
        return fail("Equal sign missing in parameter setting", in.column());
    }
    if (!values_.real_value(in, made.value)) {
        return false;
    }
    arena_.settings.push_back(made);
    ++out.setting_count;
    return true;
}

bool Parser::word(Lexer &in, Block &out, char c) {
    const int index = index_of_letter(c);
    if (index < 0 || c == 'n') {
        return fail(fmt::format("Bad character '{}' used", c), in.column());
    }
    Word made;
    made.letter = static_cast<std::uint8_t>(index);
    made.column = in.column();
    const std::uint32_t bit = 1u << made.letter;
    if (c != 'g' && c != 'm') {
        if ((letters_seen_ & bit) != 0) {
            return fail(fmt::format("Multiple {} words on one line", c), made.column);
        }
        letters_seen_ |= bit;
    }
    in.take();
    char first = in.peek();
    if (first == '\0') {
        return fail("No characters found in reading real value", in.column());
    }
    const std::size_t start = in.position();
    const bool negative = first == '-';
    if (negative) {
        in.take();
        first = in.peek();
    }
    if (Lexer::beginsNumber(first)) {  // most words: no node is needed
        const std::size_t digits = in.position();
        if (in.take_number(made.value) != Lexer::Number::OK) {
            return values_.bad_number(in, digits);
        }
        made.value = negative ? -made.value : made.value;
    } else {
        in.set_position(start);
        const std::size_t nodes = arena_.nodes.size();
        if (!values_.real_value(in, made.expression)) {
            return false;
        }
        if (const Node &node = arena_.nodes[made.expression]; node.kind == NodeKind::NUMBER) {
            made.expression = NO_ID;
            made.value = node.value;
            arena_.nodes.resize(nodes);
        }
    }
    arena_.words.push_back(made);
    ++out.word_count;
    return true;
}

// ---------------------------------------------------------------------------------------------- O words

bool Parser::oword(Lexer &in, Block &out) {
    OWord made;
    made.column = in.column();
    const bool first = out.word_count == 0 && out.setting_count == 0;
    if (!first) {
        return fail("An O word must be first on its line", made.column);
    }
    in.take();
    if (!oword_label(in, made) || !oword_keyword(in, made)) {
        return false;
    }
    if (made.kind == OKind::CALL) {
        if (!oword_call(in, out, made)) {
            return false;
        }
    } else if (takesValue(made.kind)) {
        if (in.peek() != '[') {
            return fail("Expected [ and a condition or count after the O word", in.column());
        }
        if (!values_.real_value(in, made.value)) {
            return false;
        }
    } else if (made.kind == OKind::RETURN || made.kind == OKind::ENDSUB) {
        if (in.peek() == '[' && !values_.real_value(in, made.value)) {
            return false;
        }
    }
    if (!rest_of_oword(in, out)) {
        return false;
    }
    out.oword = static_cast<std::uint32_t>(arena_.owords.size());
    arena_.owords.push_back(made);
    return true;
}

/// A number, a <name>, #parameter or [expression].
bool Parser::oword_label(Lexer &in, OWord &out) {
    const char c = in.peek();
    if (c == '<') {
        in.take();
        const auto name = in.take_name('>');
        if (!name) {
            return fail("The name of the O word has no closing >", out.column);
        }
        out.label = names_.intern(*name);
        return true;
    }
    if (c == '#' || c == '[') {
        return values_.real_value(in, out.label_expression);
    }
    double value = 0;
    if (in.take_number(value) != Lexer::Number::OK || value > 1e9) {
        return fail("An O word needs a number, a <name>, a parameter or an [expression]", in.column());
    }
    out.label = names_.intern(fmt::format("{}", static_cast<long>(value)));
    return true;
}

bool Parser::oword_keyword(Lexer &in, OWord &out) {
    const char c = in.peek();
    if (c == '\0' || c == '(' || c == ';') {
        out.kind = OKind::FANUC;
        return true;
    }
    // "else" begins "elseif", so the longest match wins.
    std::size_t longest = 0;
    const std::size_t start = in.position();
    for (const Keyword &keyword : KEYWORDS) {
        if (keyword.text.size() > longest && in.accept_word(keyword.text)) {
            longest = keyword.text.size();
            out.kind = keyword.kind;
            in.set_position(start);
        }
    }
    if (longest == 0) {
        return fail(
            "Unknown word after O word: sub, endsub, call, return, if, elseif, else, endif, while, endwhile, "
            "do, repeat, endrepeat, break or continue is expected",
            in.column());
    }
    for (const Keyword &keyword : KEYWORDS) {
        if (keyword.kind == out.kind) {
            in.accept_word(keyword.text);
        }
    }
    return true;
}

bool Parser::oword_call(Lexer &in, Block &out, OWord &made) {
    std::vector<NodeId> arguments;
    while (true) {
        const char c = in.peek();
        if (c == '(') {
            if (!comment(in, out)) {
                return false;
            }
            continue;
        }
        if (c != '[') {
            break;
        }
        NodeId node = NO_ID;
        if (!values_.real_value(in, node)) {
            return false;
        }
        arguments.push_back(node);
    }
    if (arguments.size() > MAX_CALL_ARGUMENTS) {
        return fail(fmt::format("Too many subroutine parameters: at most {}", MAX_CALL_ARGUMENTS),
                    made.column);
    }
    made.first_argument = static_cast<std::uint32_t>(arena_.arguments.size());
    made.argument_count = static_cast<std::uint32_t>(arguments.size());
    arena_.arguments.insert(arena_.arguments.end(), arguments.begin(), arguments.end());
    return true;
}

/// Only comments may follow.
bool Parser::rest_of_oword(Lexer &in, Block &out) {
    while (in.peek() != '\0') {
        if (in.peek() != '(' && in.peek() != ';') {
            return fail("Only a comment may follow here", in.column());
        }
        if (!comment(in, out)) {
            return false;
        }
    }
    return true;
}

}  // namespace mw::gcode::detail

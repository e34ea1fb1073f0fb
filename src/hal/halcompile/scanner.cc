// SPDX-License-Identifier: GPL-2.0-or-later
#include "hal/halcompile/scanner.hh"

#include <fmt/core.h>

#include "base/text.hh"
#include "hal/halcompile/code.hh"

namespace mw::halcompile {
namespace {

bool isBlank(char c) {
    return c == ' ' || c == '\t' || c == '\n' || c == '\r' || c == '\f' || c == '\v';
}

bool isNameStart(char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
}

bool isDigit(char c) {
    return c >= '0' && c <= '9';
}

int hex_digit(char c) {
    if (isDigit(c)) {
        return c - '0';
    }
    if (c >= 'a' && c <= 'f') {
        return c - 'a' + 10;
    }
    return c >= 'A' && c <= 'F' ? c - 'A' + 10 : -1;
}

}  // namespace

void Scanner::advance(std::size_t count) {
    for (; count > 0 && position_ < text_.size(); --count) {
        if (text_[position_] == '\n') {
            ++line_;
            column_ = 1;
        } else {
            ++column_;
        }
        ++position_;
    }
}

bool Scanner::accept(std::string_view what) {
    if (!isNext(what)) {
        return false;
    }
    advance(what.size());
    return true;
}

bool Scanner::skip_blank() {
    while (!isAtEnd()) {
        if (isBlank(peek())) {
            advance();
        } else if (isNext("//")) {
            while (!isAtEnd() && peek() != '\n') {
                advance();
            }
        } else if (isNext("/*")) {
            const std::size_t end = text_.find("*/", position_ + 2);
            if (end == std::string_view::npos) {
                advance(text_.size());
                return false;
            }
            advance(end + 2 - position_);
        } else {
            break;
        }
    }
    return true;
}

std::string Scanner::take_name() {
    std::string name;
    if (isNameStart(peek())) {
        while (isNameStart(peek()) || isDigit(peek())) {
            name += peek();
            advance();
        }
    }
    return name;
}

std::string Scanner::take_hal_name() {
    std::string name;
    if (isNameStart(peek())) {
        while (isNameStart(peek()) || isDigit(peek()) || peek() == '-' || peek() == '.' || peek() == '#') {
            name += peek();
            advance();
        }
    }
    return name;
}

bool Scanner::isAtString() const {
    return peek() == '"' || (peek() == 'r' && peek(1) == '"');
}

void Scanner::take_escape(std::string &out) {
    advance();
    const char kind = peek();
    static constexpr std::string_view NAMES = "nt\\\"'rabfv";
    static constexpr std::string_view MEANT = "\n\t\\\"'\r\a\b\f\v";
    const std::size_t known = NAMES.find(kind);
    if (kind == '\n') {
        advance();  // a continued line
    } else if (kind == 'x' && hex_digit(peek(1)) >= 0 && hex_digit(peek(2)) >= 0) {
        out += static_cast<char>(hex_digit(peek(1)) * 16 + hex_digit(peek(2)));
        advance(3);
    } else if (kind >= '0' && kind <= '7') {
        int value = 0;
        for (int digits = 0; digits < 3 && peek() >= '0' && peek() <= '7'; ++digits) {
            value = value * 8 + (peek() - '0');
            advance();
        }
        out += static_cast<char>(value);
    } else if (known != std::string_view::npos && kind != '\0') {
        out += MEANT[known];
        advance();
    } else {
        out += '\\';  // not an escape: both characters are kept, as in \(bu
    }
}

Result<std::string> Scanner::take_string() {
    const SourcePlace start = place();
    const bool raw = accept("r");
    const bool triple = isNext(R"(""")");
    const std::string_view quote = triple ? R"(""")" : "\"";
    if (!accept(quote)) {
        return fail("a string in double quotes is expected here", start);
    }
    std::string text;
    const std::size_t inside = position_;
    const SourcePlace inside_place = place();
    while (!isNext(quote)) {
        if (isAtEnd() || (!triple && peek() == '\n')) {
            if (!triple) {
                position_ = inside;
                line_ = inside_place.line;
                column_ = inside_place.column;
            }
            return fail("this string has no closing quote", start,
                        triple ? "" : R"(a text of several lines is between """ and """)");
        }
        if (peek() == '\\' && !raw) {
            take_escape(text);
        } else if (peek() == '\\') {
            text += peek();
            advance();
            text += peek();
            advance();
        } else {
            text += peek();
            advance();
        }
    }
    advance(quote.size());
    return text;
}

/// Skips a C string or character; false when it has no end.
bool Scanner::skip_quoted() {
    const char quote = peek();
    advance();
    while (!isAtEnd() && peek() != quote && peek() != '\n') {
        advance(peek() == '\\' ? 2 : 1);
    }
    const bool closed = peek() == quote;
    advance();
    return closed;
}

bool Scanner::isWord(std::string_view word) const {
    const auto continues_name = [](char c) { return isNameStart(c) || isDigit(c); };
    const bool is_start = position_ == 0 || !continues_name(text_[position_ - 1]);
    return is_start && !word.empty() && isNext(word) && !continues_name(peek(word.size()));
}

Result<std::string> Scanner::take_expression(std::string_view stops, std::string_view stop_word) {
    const SourcePlace start = place();
    const std::size_t from = position_;
    std::string open;
    while (!isAtEnd()) {
        const char c = peek();
        if (isNext("//") || isNext("/*")) {
            skip_blank();
            continue;
        }
        const bool is_comparison = peek(1) == '=' && (c == '=' || c == '!' || c == '<' || c == '>');
        if (is_comparison) {
            advance(2);
            continue;
        }
        if (open.empty() && (stops.find(c) != std::string_view::npos || isWord(stop_word) ||
                             (isAtString() && stops.find('"') != std::string_view::npos))) {
            return std::string(trim(text_.substr(from, position_ - from)));
        }
        if (c == ';') {
            break;
        }
        if (c == '(' || c == '[' || c == '{') {
            open += c == '(' ? ')' : c == '[' ? ']' : '}';
            if (open.size() > MOST_NESTED) {
                return fail(fmt::format("brackets are nested more than {} levels deep", MOST_NESTED),
                            place());
            }
        } else if (!open.empty() && c == open.back()) {
            open.pop_back();
        } else if (c == ')' || c == ']' || c == '}') {
            return fail(fmt::format("'{}' has no opening bracket", c), place());
        }
        if (c == '"' || c == '\'') {
            if (!skip_quoted()) {
                return fail("this string has no closing quote", start);
            }
        } else {
            advance();
        }
    }
    if (!open.empty()) {
        return fail(fmt::format("'{}' is missing", open.back()), place());
    }
    return fail(fmt::format("one of the characters {} is missing", stops), place());
}

Result<std::string> Scanner::take_braced() {
    const SourcePlace start = place();
    if (!accept("{")) {
        return fail("'{' is expected here", start);
    }
    const std::size_t from = position_;
    int depth = 1;
    while (!isAtEnd()) {
        if (isNext("//") || isNext("/*")) {
            skip_blank();
            continue;
        }
        if (peek() == '"' || peek() == '\'') {
            skip_quoted();
            continue;
        }
        depth += peek() == '{' ? 1 : peek() == '}' ? -1 : 0;
        if (depth == 0) {
            std::string text(text_.substr(from, position_ - from));
            advance();
            return text;
        }
        advance();
    }
    return fail("this '{' has no '}'", start);
}

std::optional<std::string> Scanner::take_until(char stop) {
    std::string text;
    while (peek() != stop) {
        if (isAtEnd() || peek() == '\n') {
            return {};
        }
        text += peek();
        advance();
    }
    advance();
    return text;
}

void Scanner::skip_declaration(bool (*is_start)(std::string_view line)) {
    while (!isAtEnd()) {
        if (column_ == 1 && is_start(text_.substr(position_))) {
            return;
        }
        if (isNext("//") || isNext("/*")) {
            skip_blank();
        } else if (isAtString()) {
            (void)take_string();
        } else if (accept(";")) {
            return;
        } else {
            advance();
        }
    }
}

}  // namespace mw::halcompile

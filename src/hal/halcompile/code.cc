// SPDX-License-Identifier: GPL-2.0-or-later
#include "hal/halcompile/code.hh"

namespace mw::halcompile {
namespace {

bool isWordChar(char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
}

/// End of the comment or string that starts at `at`; `at` when there is none.
std::size_t skip_inert(std::string_view code, std::size_t at) {
    const std::string_view rest = code.substr(at);
    if (rest.starts_with("//")) {
        const std::size_t end = code.find('\n', at);
        return end == std::string_view::npos ? code.size() : end;
    }
    if (rest.starts_with("/*")) {
        const std::size_t end = code.find("*/", at + 2);
        return end == std::string_view::npos ? code.size() : end + 2;
    }
    if (rest.starts_with('"') || rest.starts_with('\'')) {
        std::size_t end = at + 1;
        while (end < code.size() && code[end] != code[at] && code[end] != '\n') {
            end += code[end] == '\\' ? 2 : 1;
        }
        return end + 1 < code.size() ? end + 1 : code.size();
    }
    return at;
}

/// The word in brackets at `at`; empty when there is none.
std::string bracketed_name(std::string_view code, std::size_t at) {
    const auto skip_blank = [&] {
        while (at < code.size() && (code[at] == ' ' || code[at] == '\t')) {
            ++at;
        }
    };
    skip_blank();
    if (at >= code.size() || code[at] != '(') {
        return {};
    }
    ++at;
    skip_blank();
    std::string name;
    while (at < code.size() && (isWordChar(code[at]) || code[at] == '-' || code[at] == '.')) {
        name += code[at++];
    }
    skip_blank();
    return at < code.size() && code[at] == ')' ? name : std::string();
}

/// Tracks the nesting of C code, character by character.
class Nesting {
  public:
    /// True when `c` exceeds the limit.
    bool exceeds(char c) {
        depth_ += isOneOf(c, "([{") ? 1 : isOneOf(c, ")]}") && depth_ > 0 ? -1 : 0;
        const bool is_blank = isOneOf(c, " \t\n\r");
        signs_ = isOneOf(c, "!~-+*&") ? signs_ + 1 : is_blank ? signs_ : 0;
        return depth_ > MOST_NESTED || signs_ > MOST_NESTED;
    }

  private:
    static bool isOneOf(char c, std::string_view which) { return which.find(c) != std::string_view::npos; }

    int depth_ = 0, signs_ = 0;
};

}  // namespace

CodeFacts look_at_code(std::string_view code) {
    CodeFacts facts;
    int line = 0;
    std::size_t line_start = 0;
    bool is_directive = false;
    Nesting nesting;
    for (std::size_t at = 0; at < code.size();) {
        if (const std::size_t end = skip_inert(code, at); end != at) {
            for (; at < end; ++at) {
                if (code[at] == '\n') {
                    ++line;
                    line_start = at + 1;
                }
            }
            continue;
        }
        if (nesting.exceeds(code[at]) && !facts.deep.has_value()) {
            facts.deep =
                CodeFacts::Use{std::string(1, code[at]), line, static_cast<int>(at - line_start) + 1};
        }
        if (code[at] == '\n') {
            is_directive = is_directive && at > 0 && code[at - 1] == '\\';
            ++line;
            line_start = ++at;
            continue;
        }
        if (code[at] == '#') {
            is_directive = true;
            const std::size_t end = code.find('\n', at);
            const std::string_view directive =
                code.substr(at, end == std::string_view::npos ? end : end - at);
            facts.has_quoted_include =
                facts.has_quoted_include || (directive.find("include") != std::string_view::npos &&
                                             directive.find('"') != std::string_view::npos);
        }
        if (!isWordChar(code[at])) {
            ++at;
            continue;
        }
        const std::size_t start = at;
        while (at < code.size() && isWordChar(code[at])) {
            ++at;
        }
        facts.words.emplace(code.substr(start, at - start));
        if (code.substr(start, at - start) == "FUNCTION") {
            facts.has_function_word = true;
            const std::string name = bracketed_name(code, at);
            if (!name.empty() && !is_directive) {
                facts.functions.push_back({name, line, static_cast<int>(start - line_start) + 1});
            }
        }
    }
    return facts;
}

}  // namespace mw::halcompile

// SPDX-License-Identifier: GPL-2.0-or-later
#include "gcode/interpreter/codes/comments.hh"

#include <charconv>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "base/text.hh"
#include "gcode/syntax/lexer.hh"

namespace mw::gcode::detail {
namespace {

struct Active {
    std::string keyword;    ///< lower case, without blanks; empty for a plain comment
    std::string_view text;  ///< text after the comma
};

/// Splits "keyword," or a keyword alone at the beginning.
Active split_comment(std::string_view comment) {
    static constexpr std::string_view KEYWORDS[] = {"msg",       "debug",    "print", "log",       "logopen",
                                                    "logappend", "logclose", "abort", "probeclose"};
    static constexpr std::string_view PROBE_OPEN = "probeopen";
    const std::string_view trimmed = trim(comment);
    if (equals_ignoring_case(trimmed.substr(0, PROBE_OPEN.size()),
                             PROBE_OPEN)) {  // a blank precedes the file name
        const std::string_view rest = trimmed.substr(PROBE_OPEN.size());
        if (rest.empty() || rest[0] == ' ' || rest[0] == '\t' || rest[0] == ',') {
            return {std::string(PROBE_OPEN), rest.substr(!rest.empty() && rest[0] == ',' ? 1 : 0)};
        }
    }
    const std::size_t comma = comment.find(',');
    std::string head;
    for (const char c : comment.substr(0, comma)) {
        if (c != ' ' && c != '\t') {
            head += c;
        }
    }
    head = to_lower(head);
    const std::string_view text =
        comma == std::string_view::npos ? std::string_view{} : comment.substr(comma + 1);
    for (const std::string_view keyword : KEYWORDS) {
        const bool alone = keyword == "logclose" || keyword == "probeclose";
        if (head == keyword && (comma != std::string_view::npos || alone)) {
            return {head, text};
        }
    }
    return {};
}

/// Format of numbers: the last %d, %f or %.Nf in the comment, initially six decimals.
struct NumberFormat {
    bool integer = false;
    int decimals = 6;

    std::string str(double value) const {
        return integer ? fmt::format("{:.0f}", value) : fmt::format("{:.{}f}", value, decimals);
    }
};

/// Reads a format at the beginning of `text`; returns its length, 0 when there is none.
std::size_t take_format(std::string_view text, NumberFormat &format) {
    constexpr int SHORT_DECIMALS = 4, MAX_DECIMALS = 15;
    if (text.starts_with("%d")) {
        format = {true, 0};
        return 2;
    }
    if (text.starts_with("%f")) {
        format = {false, SHORT_DECIMALS};
        return 2;
    }
    if (text.size() >= 4 && text.starts_with("%.") && text[2] >= '0' && text[2] <= '9') {
        int decimals = 0;
        const auto [end, error] = std::from_chars(text.data() + 2, text.data() + text.size(), decimals);
        const std::size_t taken = static_cast<std::size_t>(end - text.data());
        if (error == std::errc() && decimals <= MAX_DECIMALS && taken < text.size() && text[taken] == 'f') {
            format = {false, decimals};
            return taken + 1;
        }
    }
    return 0;
}

/// Value of the parameter named at the beginning of `text` (after #), and the length of its name.
std::optional<double> comment_parameter(std::string_view text, const ShownValues &shown, std::size_t &taken) {
    if (!text.empty() && text[0] == '<') {
        const std::size_t close = text.find('>');
        if (close == std::string_view::npos) {
            return std::nullopt;
        }
        taken = close + 1;
        return shown.evaluator.named(shown.names.intern(folded_name(text.substr(1, close - 1))));
    }
    std::size_t digits = 0;
    while (digits < text.size() && text[digits] >= '0' && text[digits] <= '9') {
        ++digits;
    }
    taken = digits;
    int number = 0;
    std::from_chars(text.data(), text.data() + digits, number);
    return Evaluator::isNumber(number) ? std::optional<double>(shown.evaluator.numbered(number))
                                       : std::nullopt;
}

/// The text with #1 and #<name> replaced by their values.
std::string substituted(std::string_view text, const ShownValues &shown) {
    std::string out;
    NumberFormat format;
    std::size_t i = 0;
    while (i < text.size()) {
        if (text[i] == '%') {
            const std::size_t taken = take_format(text.substr(i), format);
            if (taken > 0) {
                i += taken;
                continue;
            }
        }
        const bool is_parameter = text[i] == '#' && i + 1 < text.size() &&
                                  (text[i + 1] == '<' || (text[i + 1] >= '0' && text[i + 1] <= '9'));
        if (!is_parameter) {
            out += text[i];
            ++i;
            continue;
        }
        std::size_t taken = 0;
        const std::optional<double> value = comment_parameter(text.substr(i + 1), shown, taken);
        if (taken == 0) {
            out += text.substr(i);
            break;
        }
        out += value ? format.str(*value) : "######";
        i += 1 + taken;
    }
    return out;
}

std::string_view after_blanks(std::string_view text) {
    const std::size_t begin = text.find_first_not_of(" \t");
    return begin == std::string_view::npos ? std::string_view() : text.substr(begin);
}

}  // namespace

bool run_comment(std::string_view comment, std::uint32_t column, const ShownValues &shown, CanonQueue &canon,
                 Fault &fault) {
    const Active active = split_comment(comment);
    const std::string_view keyword = active.keyword;
    if (keyword.empty()) {
        if (const std::string_view text = after_blanks(comment); !text.empty()) {
            canon.take(ProgramComment{std::string(text)});
        }
    } else if (keyword == "msg") {
        canon.take(OperatorMessage{std::string(active.text)});
    } else if (keyword == "debug") {
        if (shown.evaluator.numbered(P_DEBUG_SHOWN) != 0.0) {
            canon.take(OperatorMessage{substituted(active.text, shown)});
        }
    } else if (keyword == "print") {
        canon.take(PrintLine{substituted(active.text, shown)});
    } else if (keyword == "log") {
        canon.take(LogLine{substituted(active.text, shown)});
    } else if (keyword == "logopen" || keyword == "logappend") {
        const std::string_view path = trim(active.text);
        if (path.empty()) {
            return fault.set("(logopen,...) and (logappend,...) need the name of a file", column);
        }
        canon.take(OpenLog{std::string(path), keyword == "logappend"});
    } else if (keyword == "logclose") {
        canon.take(CloseLog{});
    } else if (keyword == "abort") {
        return fault.set(substituted(active.text, shown), column);
    } else {
        const std::string_view path = trim(active.text);
        if (keyword == "probeopen" && path.empty()) {
            return fault.set("(probeopen FILE) needs the name of a file", column);
        }
        canon.take(ProgramComment{std::string(trim(comment))});
        canon.take(LogProbes{std::string(keyword == "probeopen" ? path : std::string_view())});
    }
    return true;
}

}  // namespace mw::gcode::detail

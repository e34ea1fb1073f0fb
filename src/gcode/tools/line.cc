// SPDX-License-Identifier: GPL-2.0-or-later
#include "gcode/tools/line.hh"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>

#include <fmt/format.h>

#include "base/text.hh"

namespace mw::tools {
namespace {

constexpr int MAX_NUMBER = 99999999;
constexpr double MAX_VALUE = 1e9;

/// Shortest text without an exponent that reads back as the same double.
std::string fixed_text(double value) {
    char buffer[400];
    const auto [end, error] = std::to_chars(buffer, buffer + sizeof buffer, value, std::chars_format::fixed);
    return error == std::errc() ? std::string(buffer, end) : std::string("0");
}

bool isBlank(char c) {
    return c == ' ' || c == '\t' || c == '\r';
}

/// One word of a line: a letter and its number.
struct Word {
    char letter = ' ';
    double value = 0;
    int column = 0;
};

class LineParser {
  public:
    LineParser(std::string_view text, SourcePlace place) : text_(text), place_(std::move(place)) {}

    Result<ToolEntry> parse();
    Result<ToolEntry> parse(const Columns &columns);

  private:
    Result<Word> word();
    Result<double> number(char letter, std::size_t begin);
    bool isExponent(std::size_t at) const;
    Result<> apply(const Word &word);
    Result<> whole(const Word &word, int lowest, int highest, int &out);
    std::unexpected<Error> error(std::string message, int column) const {
        return fail(std::move(message), {place_.file, place_.line, column},
                    "a line is T<number> P<pocket> and offsets X..W, D, I, J, Q, then ;comment");
    }

    std::string_view text_;
    SourcePlace place_;
    std::size_t at_ = 0;
    ToolEntry entry_;
    std::string seen_;
};

Result<Word> LineParser::word() {
    Word out;
    out.column = static_cast<int>(at_) + 1;
    out.letter = static_cast<char>(std::toupper(static_cast<unsigned char>(text_[at_])));
    if (std::string_view("TPDXYZABCUVWIJQ").find(out.letter) == std::string_view::npos) {
        return error(fmt::format("'{}' is not a word of a tool table", text_[at_]), out.column);
    }
    std::size_t begin = ++at_;
    while (begin < text_.size() && isBlank(text_[begin])) {
        ++begin;
    }
    const Result<double> value = number(out.letter, begin);
    if (!value) {
        return std::unexpected(value.error());
    }
    out.value = *value;
    return out;
}

/// True for "e-3" after the digits of a number.
bool LineParser::isExponent(std::size_t at) const {
    const bool is_mark = text_[at] == 'e' || text_[at] == 'E';
    const std::size_t sign = at + 1 < text_.size() && (text_[at + 1] == '-' || text_[at + 1] == '+') ? 1 : 0;
    const std::size_t digit = at + 1 + sign;
    return is_mark && digit < text_.size() && std::isdigit(static_cast<unsigned char>(text_[digit])) != 0;
}

/// Reads the number at the position, which moves behind it.
Result<double> LineParser::number(char letter, std::size_t begin) {
    std::size_t end = begin;
    while (end < text_.size() && (std::isdigit(static_cast<unsigned char>(text_[end])) != 0 ||
                                  text_[end] == '.' || text_[end] == '+' || text_[end] == '-')) {
        ++end;
        if (end < text_.size() && isExponent(end)) {
            end += 2;
        }
    }
    const auto value = parse_double(text_.substr(begin, end - begin));
    if (!value) {
        return error(fmt::format("{} needs a number, not '{}'", letter, text_.substr(begin, end - begin)),
                     static_cast<int>(begin) + 1);
    }
    if (std::fabs(*value) > MAX_VALUE) {
        return error(fmt::format("{} is too large", letter), static_cast<int>(begin) + 1);
    }
    at_ = end;
    return *value;
}

Result<> LineParser::whole(const Word &word, int lowest, int highest, int &out) {
    const double rounded = std::round(word.value);
    if (rounded != word.value || rounded < lowest || rounded > highest) {
        return error(fmt::format("{} must be a whole number from {} to {}", word.letter, lowest, highest),
                     word.column);
    }
    out = static_cast<int>(rounded);
    return {};
}

Result<> LineParser::apply(const Word &word) {
    if (seen_.find(word.letter) != std::string::npos) {
        return error(fmt::format("{} appears twice in this line", word.letter), word.column);
    }
    seen_ += word.letter;
    switch (word.letter) {
    case 'T': return whole(word, 0, MAX_NUMBER, entry_.toolno);
    case 'P': return whole(word, 0, MAX_NUMBER, entry_.pocketno);
    case 'Q': return whole(word, 0, 9, entry_.orientation);
    case 'D': entry_.diameter = word.value; break;
    case 'I': entry_.frontangle = word.value; break;
    case 'J': entry_.backangle = word.value; break;
    default: entry_.offset[geometry::axis_of_letter(word.letter)] = word.value; break;
    }
    return {};
}

Result<ToolEntry> LineParser::parse() {
    while (at_ < text_.size()) {
        const char c = text_[at_];
        if (c == ';') {
            entry_.comment = std::string(trim(text_.substr(at_ + 1)));
            break;
        }
        if (isBlank(c)) {
            ++at_;
            continue;
        }
        const Result<Word> made = word();
        if (!made) {
            return std::unexpected(made.error());
        }
        if (const Result<> done = apply(*made); !done) {
            return std::unexpected(done.error());
        }
    }
    if (entry_.toolno < 0) {
        return error("the line has no T word", 1);
    }
    if (seen_.find('P') == std::string::npos) {
        entry_.pocketno = NO_POCKET;
    }
    return entry_;
}

/// Reads numbers in the order of the columns, then the comment.
Result<ToolEntry> LineParser::parse(const Columns &columns) {
    std::size_t used = 0;
    for (; used < columns.size(); ++used) {
        while (at_ < text_.size() && isBlank(text_[at_])) {
            ++at_;
        }
        const bool is_remark = at_ >= text_.size() || text_[at_] == ';';
        if (is_remark) {
            break;
        }
        Word word;
        word.letter = columns[used];
        word.column = static_cast<int>(at_) + 1;
        const Result<double> value = number(word.letter, at_);
        if (!value) {
            return std::unexpected(value.error());
        }
        word.value = *value;
        if (const Result<> done = apply(word); !done) {
            return std::unexpected(done.error());
        }
    }
    constexpr std::size_t LEAST = 4;
    if (used < std::min(LEAST, columns.size())) {
        return error("a line of the older form needs pocket, tool number, length and diameter", 1);
    }
    if (entry_.toolno < 0 || seen_.find('P') == std::string::npos) {
        return error("the columns have no tool number or no pocket", 1);
    }
    const std::string_view rest = trim(text_.substr(std::min(at_, text_.size())));
    entry_.comment = std::string(trim(rest.starts_with(';') ? rest.substr(1) : rest));
    return entry_;
}

}  // namespace

bool hasTool(std::string_view line) {
    return !trim(line.substr(0, line.find(';'))).empty();
}

bool isInColumns(std::string_view line) {
    const std::string_view content = trim(line);
    return !content.empty() && (std::isdigit(static_cast<unsigned char>(content.front())) != 0);
}

const Columns &columns_of_mills() {
    static const Columns COLUMNS{'P', 'T', 'Z', 'D'};
    return COLUMNS;
}

std::optional<Columns> columns_of_header(std::string_view line) {
    struct Name {
        std::string_view name;
        char letter;
    };
    constexpr Name NAMES[] = {{"POC", 'P'},        {"POCKET", 'P'},     {"FMS", 'T'},       {"TOOLNO", 'T'},
                              {"TOOL", 'T'},       {"LEN", 'Z'},        {"LENGTH", 'Z'},    {"TLO", 'Z'},
                              {"ZOFF", 'Z'},       {"XOFF", 'X'},       {"DIAM", 'D'},      {"DIA", 'D'},
                              {"DIAMETER", 'D'},   {"FRONTANGLE", 'I'}, {"BACKANGLE", 'J'}, {"ORIENT", 'Q'},
                              {"ORIENTATION", 'Q'}};
    Columns columns;
    for (const std::string &word : split_words(line)) {
        std::string upper;
        for (const char c : word) {
            upper += static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
        }
        if (upper == "COMMENT" || upper == "REMARK") {
            break;
        }
        const auto *known = std::ranges::find(NAMES, std::string_view(upper), &Name::name);
        if (known == std::end(NAMES) || std::ranges::find(columns, known->letter) != columns.end()) {
            return std::nullopt;
        }
        columns.push_back(known->letter);
    }
    const bool has_both =
        std::ranges::find(columns, 'P') != columns.end() && std::ranges::find(columns, 'T') != columns.end();
    return has_both ? std::optional(columns) : std::nullopt;
}

Result<ToolEntry> parse_line(std::string_view line, const SourcePlace &place) {
    return LineParser(line, place).parse();
}

Result<ToolEntry> parse_columns(std::string_view line, const Columns &columns, const SourcePlace &place) {
    return LineParser(line, place).parse(columns);
}

std::string format_entry(const ToolEntry &entry) {
    std::string out = fmt::format("T{} P{}", entry.toolno, entry.pocketno);
    const auto add = [&out](char letter, double value) {
        if (value != 0.0) {
            out += fmt::format(" {}{}", letter, fixed_text(value));
        }
    };
    for (int axis = 0; axis < geometry::AXIS_COUNT; ++axis) {
        add(geometry::AXIS_LETTERS[axis], entry.offset[axis]);
    }
    add('D', entry.diameter);
    add('I', entry.frontangle);
    add('J', entry.backangle);
    add('Q', entry.orientation);
    return entry.comment.empty() ? out : out + " ;" + entry.comment;
}

}  // namespace mw::tools

// SPDX-License-Identifier: GPL-2.0-or-later
#include "tool/table.hh"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>

#include <fmt/format.h>

#include "base/atomic_file.hh"
#include "base/text.hh"

namespace mw::tool {
namespace {

constexpr int MAX_NUMBER = 99999999;
constexpr double MAX_VALUE = 1e9;

/// Shortest text without an exponent that reads back as the same double.
std::string fixed_text(double value) {
    char buffer[400];
    const auto [end, error] = std::to_chars(buffer, buffer + sizeof buffer, value, std::chars_format::fixed);
    return error == std::errc() ? std::string(buffer, end) : std::string("0");
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

  private:
    Result<Word> word();
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
    while (begin < text_.size() && (text_[begin] == ' ' || text_[begin] == '\t')) {
        ++begin;
    }
    std::size_t end = begin;
    while (end < text_.size() && (std::isdigit(static_cast<unsigned char>(text_[end])) != 0 ||
                                  text_[end] == '.' || text_[end] == '+' || text_[end] == '-')) {
        ++end;
    }
    const auto number = parse_double(text_.substr(begin, end - begin));
    if (!number) {
        return error(fmt::format("{} needs a number, not '{}'", out.letter, text_.substr(begin, end - begin)),
                     static_cast<int>(begin) + 1);
    }
    if (std::fabs(*number) > MAX_VALUE) {
        return error(fmt::format("{} is too large", out.letter), static_cast<int>(begin) + 1);
    }
    out.value = *number;
    at_ = end;
    return out;
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
        return error(fmt::format("{} stands twice in this line", word.letter), word.column);
    }
    seen_ += word.letter;
    switch (word.letter) {
    case 'T': return whole(word, 0, MAX_NUMBER, entry_.toolno);
    case 'P': return whole(word, 0, MAX_NUMBER, entry_.pocketno);
    case 'Q': return whole(word, 0, 9, entry_.orientation);
    case 'D': entry_.diameter = word.value; break;
    case 'I': entry_.frontangle = word.value; break;
    case 'J': entry_.backangle = word.value; break;
    default: entry_.offset[geom::axis_of_letter(word.letter)] = word.value; break;
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
        if (c == ' ' || c == '\t' || c == '\r') {
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
        return error(fmt::format("tool {} has no P word (its pocket)", entry_.toolno), 1);
    }
    return entry_;
}

bool hasTool(std::string_view line) {
    const std::string_view content = trim(line.substr(0, line.find(';')));
    return !content.empty();
}

}  // namespace

void Table::clear_spindle() {
    entries_[0] = ToolEntry{};
    entries_[0].toolno = 0;
}

Result<Table> Table::load(const std::string &path) {
    const Result<std::string> text = read_file(path);
    if (!text) {
        return std::unexpected(text.error());
    }
    return parse(*text, path);
}

namespace {

/// The lines of a text without their ends.
std::vector<std::string> lines_of(std::string_view text) {
    std::vector<std::string> lines;
    for (std::size_t begin = 0; begin < text.size();) {
        const std::size_t end = std::min(text.find('\n', begin), text.size());
        lines.emplace_back(text.substr(begin, end - begin));
        begin = end + 1;
        if (!lines.back().empty() && lines.back().back() == '\r') {
            lines.back().pop_back();
        }
    }
    return lines;
}

/// True when both do the same to a machine.
bool isSameTool(const ToolEntry &a, const ToolEntry &b) {
    return a.offset == b.offset && a.diameter == b.diameter && a.frontangle == b.frontangle &&
           a.backangle == b.backangle && a.orientation == b.orientation;
}

}  // namespace

std::vector<Error> Table::take_lines(std::string_view text, const std::string &path) {
    std::vector<Error> bad;
    int number = 0;
    for (const std::string &content : lines_of(text)) {
        ++number;
        Line line{content, 0, false};
        if (hasTool(content)) {
            const Result<ToolEntry> entry = LineParser(content, {path, number, 0}).parse();
            if (entry) {
                line.entry = count();
                entries_.push_back(*entry);
            } else {
                bad.push_back(entry.error());
            }
        }
        lines_.push_back(std::move(line));
    }
    return bad;
}

Result<Table> Table::parse(std::string_view text, const std::string &path) {
    Table table;
    std::vector<Error> bad = table.take_lines(text, path);
    for (std::size_t i = 0; i < table.lines_.size(); ++i) {
        const int index = table.lines_[i].entry;
        if (index > 0 && table.index_of_tool(table.entry(index).toolno) < index) {
            bad.push_back({fmt::format("tool {} is in the table twice", table.entry(index).toolno),
                           {path, static_cast<int>(i) + 1, 1},
                           {}});
        }
    }
    if (!bad.empty()) {
        return std::unexpected(
            *std::ranges::min_element(bad, {}, [](const Error &e) { return e.place.line; }));
    }
    return table;
}

Table Table::parse_leniently(std::string_view text, const std::string &path, diag::Sink &sink) {
    Table table;
    for (const Error &error : table.take_lines(text, path)) {
        sink.warning(error.message + ": the line is skipped", error.place, error.hint);
    }
    table.check(path, sink);
    return table;
}

/// Warns of what looks wrong, and takes out what must not be used.
void Table::check(const std::string &path, diag::Sink &sink) {
    std::vector<int> line_of(entries_.size(), 0);
    for (std::size_t i = 0; i < lines_.size(); ++i) {
        line_of[static_cast<std::size_t>(lines_[i].entry)] = static_cast<int>(i) + 1;
    }
    for (std::size_t i = 1; i < entries_.size(); ++i) {
        const ToolEntry &tool = entries_[i];
        const SourcePlace place{path, line_of[i], 1};
        if (tool.toolno == 0) {
            sink.warning("T0 stands for an empty spindle: a program cannot load this tool", place);
        }
        if (tool.pocketno == 0) {
            sink.warning(fmt::format("tool {}: P0 stands for the spindle, not for a pocket", tool.toolno),
                         place);
        }
        if (tool.diameter < 0.0) {
            sink.warning(fmt::format("tool {}: a diameter of {} is negative: compensation with it goes to "
                                     "the other side",
                                     tool.toolno, fixed_text(tool.diameter)),
                         place);
        }
        for (std::size_t earlier = 1; earlier < i; ++earlier) {
            if (entries_[earlier].pocketno == tool.pocketno && entries_[earlier].toolno != tool.toolno &&
                tool.pocketno != 0) {
                sink.warning(fmt::format("tools {} (line {}) and {} are in one pocket, P{}",
                                         entries_[earlier].toolno, line_of[earlier], tool.toolno,
                                         tool.pocketno),
                             place);
                break;
            }
        }
    }
    for (std::size_t i = entries_.size(); i-- > 1;) {
        check_twice(i, line_of, path, sink);
    }
}

/// Takes entry `later` out when its tool stands earlier too; both when they differ.
void Table::check_twice(std::size_t later, const std::vector<int> &line_of, const std::string &path,
                        diag::Sink &sink) {
    constexpr int NOBODY = -1;
    const auto earlier = static_cast<std::size_t>(std::max(0, index_of_tool(entries_[later].toolno)));
    if (entries_[later].toolno == NOBODY || earlier == 0 || earlier >= later) {
        return;
    }
    const bool isSame = isSameTool(entries_[earlier], entries_[later]);
    sink.warning(fmt::format("tool {} stands in lines {} and {}{}", entries_[later].toolno, line_of[earlier],
                             line_of[later],
                             isSame ? ": the first one counts"
                                    : " with different figures: it cannot be used until one of them goes"),
                 {path, line_of[later], 1});
    const int number = entries_[later].toolno;
    entries_[later].toolno = NOBODY;
    if (!isSame) {
        for (std::size_t i = 1; i < entries_.size(); ++i) {
            entries_[i].toolno = entries_[i].toolno == number ? NOBODY : entries_[i].toolno;
        }
    }
}

int Table::index_of_tool(int toolno) const {
    for (std::size_t i = 1; i < entries_.size(); ++i) {
        if (entries_[i].toolno == toolno) {
            return static_cast<int>(i);
        }
    }
    return -1;
}

int Table::index_of_pocket(int pocketno) const {
    for (std::size_t i = 1; i < entries_.size(); ++i) {
        if (entries_[i].pocketno == pocketno) {
            return static_cast<int>(i);
        }
    }
    return -1;
}

void Table::set_entry(int index, const ToolEntry &entry) {
    entries_[static_cast<std::size_t>(index)] = entry;
    for (Line &line : lines_) {
        if (index > 0 && line.entry == index) {
            line.isChanged = true;
        }
    }
}

void Table::add(const ToolEntry &entry) {
    lines_.push_back({{}, count(), true});
    entries_.push_back(entry);
}

void Table::load_spindle(int index) {
    if (index <= 0 || index >= count()) {
        clear_spindle();
    } else {
        entries_[0] = entries_[static_cast<std::size_t>(index)];
    }
}

std::string Table::text() const {
    std::string out;
    for (const Line &line : lines_) {
        out += line.isChanged ? format_entry(entry(line.entry)) : line.text;
        out += '\n';
    }
    return out;
}

Result<> Table::save(const std::string &path) const {
    return write_file_atomically(path, text());
}

std::string format_entry(const ToolEntry &entry) {
    std::string out = fmt::format("T{} P{}", entry.toolno, entry.pocketno);
    const auto add = [&out](char letter, double value) {
        if (value != 0.0) {
            out += fmt::format(" {}{}", letter, fixed_text(value));
        }
    };
    for (int axis = 0; axis < geom::AXIS_COUNT; ++axis) {
        add(geom::AXIS_LETTERS[axis], entry.offset[axis]);
    }
    add('D', entry.diameter);
    add('I', entry.frontangle);
    add('J', entry.backangle);
    add('Q', entry.orientation);
    return entry.comment.empty() ? out : out + " ;" + entry.comment;
}

}  // namespace mw::tool

// SPDX-License-Identifier: GPL-2.0-or-later
#include "tool/table.hh"

#include <cmath>
#include <optional>

#include "base/text.hh"

namespace mw::tool {
namespace {

constexpr int MAX_TOOL_NUMBER = 99999;
constexpr int MAX_POCKET = 1000;

/// Reads the words of one line.
class LineParser {
  public:
    LineParser(std::string_view text, SourcePlace place) : text_(text), place_(std::move(place)) {}

    Result<ToolEntry> entry() {
        const auto semicolon = text_.find(';');
        if (semicolon != std::string_view::npos) {
            entry_.comment = trim(text_.substr(semicolon + 1));
        }
        const std::string_view words = text_.substr(0, semicolon);
        std::size_t at = 0;
        while (true) {
            while (at < words.size() && (words[at] == ' ' || words[at] == '\t' || words[at] == '\r')) {
                ++at;
            }
            if (at >= words.size()) {
                break;
            }
            std::size_t end = words.find_first_of(" \t\r", at);
            end = end == std::string_view::npos ? words.size() : end;
            const auto taken = word(words.substr(at, end - at), static_cast<int>(at) + 1);
            if (!taken.has_value()) {
                return std::unexpected(taken.error());
            }
            at = end;
        }
        return check();
    }

  private:
    std::unexpected<Error> wrong(int column, std::string message, std::string hint = {}) const {
        SourcePlace place = place_;
        place.column = column;
        return fail(std::move(message), place, std::move(hint));
    }

    Result<> word(std::string_view word, int column) {
        const char letter = to_upper(word.substr(0, 1))[0];
        if (seen_.find(letter) != std::string::npos) {
            return wrong(column, std::string("word ") + letter + " is given twice in this tool");
        }
        seen_ += letter;
        const auto value = parse_double(word.substr(1));
        if (!value.has_value()) {
            return wrong(column, "'" + std::string(word) + "' is not a letter and a number",
                         "expected words like T1 P1 D6.0 Z40.5, and a comment after ;");
        }
        const int axis = geom::axis_of_letter(letter);
        if (axis >= 0) {
            entry_.offset[axis] = *value;
            return {};
        }
        switch (letter) {
        case 'T': return whole(*value, column, 0, MAX_TOOL_NUMBER, entry_.toolno);
        case 'P': return whole(*value, column, 0, MAX_POCKET, entry_.pocketno);
        case 'Q': return whole(*value, column, 0, 9, entry_.orientation);
        case 'D': entry_.diameter = *value; return {};
        case 'I': entry_.frontangle = *value; return {};
        case 'J': entry_.backangle = *value; return {};
        default: break;
        }
        return wrong(column, std::string("unknown word ") + letter, "expected T P D X Y Z A B C U V W I J Q");
    }

    Result<> whole(double value, int column, int lowest, int highest, int &target) const {
        if (value != std::floor(value) || value < lowest || value > highest) {
            return wrong(column, "expected a whole number from " + std::to_string(lowest) + " to " +
                                     std::to_string(highest));
        }
        target = static_cast<int>(value);
        return {};
    }

    Result<ToolEntry> check() const {
        if (seen_.find('T') == std::string::npos) {
            return wrong(1, "a tool without its number (T)");
        }
        if (entry_.toolno == 0) {
            return wrong(1, "T0 means no tool and may not be in the table");
        }
        return entry_;
    }

    std::string_view text_;
    SourcePlace place_;
    ToolEntry entry_{};
    std::string seen_;
};

void append_word(std::string &line, char letter, double value, bool isSigned) {
    if (value != 0) {
        line += std::string(" ") + letter + (isSigned && value > 0 ? "+" : "") + to_text(value);
    }
}

std::string format_entry(const ToolEntry &entry) {
    std::string line = 'T' + std::to_string(entry.toolno) + " P" + std::to_string(entry.pocketno);
    append_word(line, 'D', entry.diameter, true);
    for (int axis = 0; axis < geom::AXIS_COUNT; ++axis) {
        append_word(line, geom::AXIS_LETTERS[axis], entry.offset[axis], true);
    }
    append_word(line, 'I', entry.frontangle, true);
    append_word(line, 'J', entry.backangle, true);
    append_word(line, 'Q', entry.orientation, false);
    return entry.comment.empty() ? line : line + " ;" + entry.comment;
}

}  // namespace

Result<Table> Table::parse(std::string_view text, const std::string &path) {
    Table table;
    int line = 0;
    while (!text.empty()) {
        ++line;
        const auto end = text.find('\n');
        const std::string_view one = text.substr(0, end);
        text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
        const std::string_view body = trim(one);
        if (body.empty() || body[0] == ';') {
            table.lines_.push_back({0, std::string(body)});
            continue;
        }
        const auto entry = LineParser(one, {path, line, 1}).entry();
        if (!entry.has_value()) {
            return std::unexpected(entry.error());
        }
        if (table.index_of_tool(entry->toolno) > 0) {
            return fail("tool " + std::to_string(entry->toolno) + " is in the table twice", {path, line, 1});
        }
        table.entries_.push_back(*entry);
        table.lines_.push_back({table.count() - 1, {}});
    }
    return table;
}

std::string Table::format() const {
    std::string text;
    for (const TextLine &line : lines_) {
        text += (line.index > 0 ? format_entry(entry(line.index)) : line.comment) + '\n';
    }
    return text;
}

int Table::index_of_tool(int toolno) const {
    for (int i = 1; i < count(); ++i) {
        if (entry(i).toolno == toolno) {
            return i;
        }
    }
    return -1;
}

void Table::load_spindle(int index) {
    entries_[0] = ToolEntry{};
    if (index > 0) {
        entries_[0] = entry(index);
    } else {
        entries_[0].toolno = 0;
    }
}

void Table::set_entry(int index, const ToolEntry &changed) {
    entries_[static_cast<std::size_t>(index)] = changed;
    if (index > 0 && entries_[0].toolno == changed.toolno) {
        entries_[0] = changed;
    }
}

}  // namespace mw::tool

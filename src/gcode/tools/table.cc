// SPDX-License-Identifier: GPL-2.0-or-later
#include "gcode/tools/table.hh"

#include <algorithm>
#include <span>
#include <unordered_map>
#include <utility>

#include <fmt/format.h>

#include "base/atomic_file.hh"
#include "base/diagnostics/message_limit.hh"
#include "base/text.hh"

namespace mw::tools {
namespace {

constexpr int NOBODY = -1;

/// The first index of each tool number.
using FirstIndices = std::unordered_map<int, std::size_t>;

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

/// True when both have the same effect on a machine.
bool isSameTool(const ToolEntry &a, const ToolEntry &b) {
    return a.offset == b.offset && a.diameter == b.diameter && a.frontangle == b.frontangle &&
           a.backangle == b.backangle && a.orientation == b.orientation;
}

ToolEntry empty_pocket(int pocketno) {
    ToolEntry none;
    none.toolno = NOBODY;
    none.pocketno = pocketno;
    return none;
}

std::span<const diagnostics::Diagnostic> first_of(const diagnostics::Sink &sink) {
    return std::span(sink.all()).first(std::min(sink.all().size(), diagnostics::MOST_OF_A_FILE));
}

}  // namespace

/// A text while it is read into a table.
struct Table::Reading {
    std::string path;
    std::vector<ReadTool> tools{};
    diagnostics::Sink skipped{};  ///< lines that are not usable
    diagnostics::Sink doubts{};   ///< lines that are doubtful
    Columns columns = columns_of_mills();
    bool old_form_reported = false;

    SourcePlace place_of(const ReadTool &tool) const { return {path, static_cast<int>(tool.line) + 1, 1}; }
    int line_of(const ReadTool &tool) const { return static_cast<int>(tool.line) + 1; }
};

Table::Table(Changer changer) : changer_(changer), entries_(1) {
    clear_spindle();
}

void Table::clear_spindle() {
    entries_[0] = ToolEntry{};
    entries_[0].toolno = isRandom() ? NOBODY : 0;
}

Result<Table> Table::load(const std::string &path) {
    const Result<std::string> text = read_file(path);
    if (!text) {
        return std::unexpected(text.error());
    }
    return parse(without_byte_order_mark(*text), path);
}

void Table::take_tool(const Result<ToolEntry> &made, Reading &reading) {
    const SourcePlace place{reading.path, static_cast<int>(lines_.size()), 1};
    if (!made) {
        reading.skipped.warning(made.error().message, made.error().place, made.error().hint);
        return;
    }
    ReadTool tool{*made, lines_.size() - 1};
    const bool has_pocket = tool.entry.pocketno != NO_POCKET;
    if (!has_pocket && isRandom()) {
        reading.skipped.warning(fmt::format("tool {} has no P word (its pocket)", tool.entry.toolno), place,
                                "a random tool changer needs the pocket of each tool");
        return;
    }
    if (!has_pocket) {
        reading.doubts.warning(fmt::format("tool {} has no P word (its pocket)", tool.entry.toolno), place);
        tool.entry.pocketno = 0;
    }
    if (isRandom() && tool.entry.pocketno > MAX_POCKET) {
        reading.skipped.warning(fmt::format("tool {}: P{} is above {}, the highest pocket", tool.entry.toolno,
                                            tool.entry.pocketno, MAX_POCKET),
                                place);
        return;
    }
    reading.tools.push_back(std::move(tool));
}

void Table::take_text(std::string_view text, Reading &reading) {
    for (const std::string &content : lines_of(text)) {
        lines_.push_back({content});
        Line &line = lines_.back();
        if (!hasTool(content)) {
            continue;
        }
        const SourcePlace place{reading.path, static_cast<int>(lines_.size()), 0};
        const auto header = columns_of_header(content);
        line.is_old_form = header.has_value() || isInColumns(content);
        if (line.is_old_form && !std::exchange(reading.old_form_reported, true)) {
            reading.doubts.note("the tool table has an older format: it is written in the current format at "
                                "the next tool change",
                                place);
        }
        if (header.has_value()) {
            reading.columns = *header;
        } else if (line.is_old_form) {
            take_tool(parse_columns(content, reading.columns, place), reading);
        } else {
            take_tool(parse_line(content, place), reading);
        }
    }
}

/// Rejects a tool that occurs twice, and two tools in one pocket of a random changer.
void Table::refuse_twice(Reading &reading) const {
    FirstIndices of_tool, of_pocket;
    for (std::size_t i = 0; i < reading.tools.size(); ++i) {
        const ToolEntry &tool = reading.tools[i].entry;
        std::size_t first = of_tool.try_emplace(tool.toolno, i).first->second;
        if (isRandom()) {
            first = std::min(first, of_pocket.try_emplace(tool.pocketno, i).first->second);
        }
        if (first == i) {
            continue;
        }
        const ToolEntry &same = reading.tools[first].entry;
        const bool is_tool = same.toolno == tool.toolno;
        reading.skipped.warning(is_tool ? fmt::format("tool {} is in the table twice", tool.toolno)
                                        : fmt::format("tools {} and {} are in one pocket, P{}", same.toolno,
                                                      tool.toolno, tool.pocketno),
                                reading.place_of(reading.tools[i]));
    }
}

Result<Table> Table::parse(std::string_view text, const std::string &path, Changer changer) {
    Table table(changer);
    Reading reading{path};
    table.take_text(text, reading);
    table.refuse_twice(reading);
    if (reading.skipped.all().empty()) {
        table.place(reading);
        return table;
    }
    const auto &all = reading.skipped.all();
    const auto first =
        std::ranges::min_element(all, {}, [](const diagnostics::Diagnostic &d) { return d.what.place.line; });
    return std::unexpected(first->what);
}

Table Table::parse_leniently(std::string_view text, const std::string &path, diagnostics::Sink &sink,
                             Changer changer) {
    Table table(changer);
    Reading reading{path};
    table.take_text(text, reading);
    for (const diagnostics::Diagnostic &one : first_of(reading.skipped)) {
        sink.warning(one.what.message + ": the line is skipped", one.what.place, one.what.hint);
    }
    table.check(reading);
    for (const diagnostics::Diagnostic &one : first_of(reading.doubts)) {
        sink.report(one);
    }
    const std::size_t all = reading.skipped.all().size() + reading.doubts.all().size();
    const std::size_t told = first_of(reading.skipped).size() + first_of(reading.doubts).size();
    if (all > told) {
        sink.warning(fmt::format("{} more lines have errors or warnings", all - told), {path, 0, 0});
    }
    table.place(reading);
    return table;
}

/// Warns of doubtful lines, and marks lines that must not be used.
void Table::check(Reading &reading) const {
    for (const ReadTool &read : reading.tools) {
        const ToolEntry &tool = read.entry;
        const SourcePlace place = reading.place_of(read);
        if (tool.toolno == 0 && !isRandom()) {
            reading.doubts.warning("T0 means an empty spindle: a program cannot load this tool", place);
        }
        if (tool.pocketno == 0 && !isRandom()) {
            reading.doubts.warning(fmt::format("tool {}: P0 is the spindle, not a pocket", tool.toolno),
                                   place);
        }
        if (tool.diameter < 0.0) {
            reading.doubts.warning(
                fmt::format("tool {}: the diameter {} is negative: cutter compensation is on the other side",
                            tool.toolno, tool.diameter),
                place);
        }
    }
    check_pockets(reading);
    check_numbers(reading);
}

/// Checks for tools with several lines.
void Table::check_numbers(Reading &reading) {
    FirstIndices of_tool;
    for (std::size_t i = 0; i < reading.tools.size(); ++i) {
        of_tool.try_emplace(reading.tools[i].entry.toolno, i);
    }
    for (std::size_t later = reading.tools.size(); later-- > 0;) {
        ReadTool &tool = reading.tools[later];
        const int number = tool.entry.toolno;
        const std::size_t first = of_tool.at(number);
        if (first == later) {
            continue;
        }
        ReadTool &earlier = reading.tools[first];
        const bool is_same = isSameTool(earlier.entry, tool.entry);
        reading.doubts.warning(
            fmt::format("tool {} is defined in lines {} and {}{}", number, reading.line_of(earlier),
                        reading.line_of(tool),
                        is_same ? ": the first line is used"
                                : " with different data: the tool cannot be used until you delete a line"),
            reading.place_of(tool));
        tool.usable = false;
        earlier.usable = earlier.usable && is_same;
    }
}

/// Checks for several tools in one pocket: compares each with the first other tool there.
void Table::check_pockets(Reading &reading) const {
    struct Pocket {
        std::size_t first;                  ///< index of its first tool
        std::optional<std::size_t> second;  ///< the first tool with another number
    };
    std::unordered_map<int, Pocket> pockets;
    for (std::size_t later = 0; later < reading.tools.size(); ++later) {
        ReadTool &tool = reading.tools[later];
        if (tool.entry.pocketno == 0 && !isRandom()) {
            continue;
        }
        Pocket &pocket = pockets.try_emplace(tool.entry.pocketno, Pocket{later, {}}).first->second;
        const bool other = reading.tools[pocket.first].entry.toolno != tool.entry.toolno;
        if (!other && !pocket.second.has_value()) {
            continue;
        }
        ReadTool &earlier = reading.tools[other ? pocket.first : *pocket.second];
        pocket.second = pocket.second.value_or(later);
        reading.doubts.warning(
            fmt::format("tools {} (line {}) and {} are in one pocket, P{}{}", earlier.entry.toolno,
                        reading.line_of(earlier), tool.entry.toolno, tool.entry.pocketno,
                        isRandom() ? ": neither tool can be used until you delete a line" : ""),
            reading.place_of(tool));
        if (isRandom()) {
            earlier.usable = tool.usable = false;
        }
    }
}

/// Moves usable tools to their indices; other lines remain text.
void Table::place(const Reading &reading) {
    for (const ReadTool &tool : reading.tools) {
        if (tool.usable) {
            lines_[tool.line].entry = isRandom() ? tool.entry.pocketno : count();
        } else {
            lines_[tool.line].unused = {tool.entry.toolno, tool.entry.pocketno};
        }
        if (isRandom() && tool.usable) {
            for (int pocket = count(); pocket <= tool.entry.pocketno; ++pocket) {
                entries_.push_back(empty_pocket(pocket));
            }
            entries_[static_cast<std::size_t>(tool.entry.pocketno)] = tool.entry;
        } else if (!isRandom()) {
            entries_.push_back(tool.entry);
            entries_.back().toolno = tool.usable ? tool.entry.toolno : NOBODY;
        }
    }
}

int Table::index_of_tool(int toolno) const {
    const int lowest = isRandom() ? 0 : 1;
    for (int i = lowest; i < count() && toolno >= lowest; ++i) {
        if (entry(i).toolno == toolno) {
            return i;
        }
    }
    return -1;
}

int Table::index_of_pocket(int pocketno) const {
    for (int i = isRandom() ? 0 : 1; i < count(); ++i) {
        if (entry(i).pocketno == pocketno) {
            return i;
        }
    }
    return -1;
}

void Table::set_entry(int index, const ToolEntry &entry) {
    ToolEntry &mine = entries_[static_cast<std::size_t>(index)];
    const int toolno = mine.toolno, pocketno = mine.pocketno;
    mine = entry;
    const bool is_copy = index == 0 && !isRandom();
    if (!is_copy) {
        mine.toolno = toolno;
        mine.pocketno = pocketno;
    }
    for (Line &line : lines_) {
        line.changed = line.changed || line.entry == index;
    }
}

void Table::add(const ToolEntry &entry) {
    const int index = isRandom() ? entry.pocketno : count();
    for (int pocket = count(); pocket <= index; ++pocket) {
        entries_.push_back(empty_pocket(pocket));
    }
    lines_.push_back({{}, index, {}, true, false});
    entries_[static_cast<std::size_t>(index)] = entry;
}

int Table::owner_of(int pocketno) const {
    const int lowest = isRandom() ? 0 : 1;
    for (int i = lowest; i < count(); ++i) {
        if (entry(i).toolno >= lowest && entry(i).pocketno == pocketno) {
            return entry(i).toolno;
        }
    }
    for (const Line &line : lines_) {
        if (line.unused.has_value() && line.unused->second == pocketno) {
            return line.unused->first;
        }
    }
    return NOBODY;
}

Result<int> Table::put(ToolEntry entry) {
    if (entry.toolno <= 0) {
        return fail("a new tool needs a number of 1 or more");
    }
    if (index_of_tool(entry.toolno) >= 0) {
        return fail(fmt::format("tool {} is in the tool table already", entry.toolno));
    }
    if (std::ranges::any_of(lines_, [&](const Line &line) {
            return line.unused.has_value() && line.unused->first == entry.toolno;
        })) {
        return fail(fmt::format("the tool table has contradictory lines for tool {}", entry.toolno), {},
                    "correct the lines in the file, then load the tool table again");
    }
    if (entry.pocketno == 0) {
        const bool own_free = entry.toolno <= MAX_POCKET && owner_of(entry.toolno) == NOBODY;
        int pocket = own_free ? entry.toolno : 1;
        while (pocket <= MAX_POCKET && owner_of(pocket) != NOBODY) {
            ++pocket;
        }
        if (pocket > MAX_POCKET) {
            return fail(fmt::format("there is no free pocket for tool {}: the last pocket is {}",
                                    entry.toolno, MAX_POCKET));
        }
        entry.pocketno = pocket;
    }
    if (entry.pocketno < 0 || entry.pocketno > MAX_POCKET) {
        return fail(fmt::format("tool {} has pocket {}: pockets are 1 to {}", entry.toolno, entry.pocketno,
                                MAX_POCKET));
    }
    if (const int owner = owner_of(entry.pocketno); owner != NOBODY) {
        return fail(fmt::format("pocket {} is occupied by tool {}", entry.pocketno, owner));
    }
    add(entry);
    return index_of_tool(entry.toolno);
}

Result<> Table::remove(int index) {
    const int lowest = isRandom() ? 0 : 1;
    const bool present = index >= lowest && index < count() && entry(index).toolno >= lowest;
    if (!present) {
        return fail(fmt::format("the tool table has no entry {}", index));
    }
    const int toolno = entry(index).toolno;
    if (toolno == entry(0).toolno) {
        return fail(
            fmt::format("tool {} is in the spindle: it is removed after the next tool change", toolno));
    }
    entries_[static_cast<std::size_t>(index)] = empty_pocket(isRandom() ? index : 0);
    std::erase_if(lines_, [index, toolno](const Line &line) {
        return line.entry == index || (line.unused.has_value() && line.unused->first == toolno);
    });
    return {};
}

void Table::load_spindle(int index) {
    const bool present = index > 0 && index < count();
    if (!isRandom()) {
        entries_[0] = present ? entry(index) : entries_[0];
        if (!present) {
            clear_spindle();
        }
        return;
    }
    if (!present) {
        return;
    }
    ToolEntry &pocket = entries_[static_cast<std::size_t>(index)];
    std::swap(entries_[0], pocket);
    entries_[0].pocketno = 0;
    pocket.pocketno = index;
    for (Line &line : lines_) {
        if (line.entry == 0 || line.entry == index) {
            line.entry = line.entry == 0 ? index : 0;
            line.changed = true;
        }
    }
}

std::string Table::text() const {
    const bool is_new = std::ranges::any_of(lines_, [](const Line &line) { return line.changed; });
    std::string out;
    for (const Line &line : lines_) {
        const bool is_tool = line.entry != NO_TOOL;
        if (is_tool && (line.changed || (is_new && line.is_old_form))) {
            out += format_entry(entry(line.entry));
        } else {
            out += (is_new && line.is_old_form ? "; " : "") + line.text;
        }
        out += '\n';
    }
    return out;
}

Result<> Table::save(const std::string &path) const {
    return write_file_atomically(path, text());
}

}  // namespace mw::tools

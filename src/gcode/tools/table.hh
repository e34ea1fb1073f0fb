// SPDX-License-Identifier: GPL-2.0-or-later
// The tool table: the classic text file and what is in the spindle.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/diagnostics/sink.hh"
#include "base/result.hh"
#include "gcode/tools/entry.hh"
#include "gcode/tools/line.hh"

namespace mw::tools {

/// What a changer does with the tool that it takes out of the spindle ([EMCIO]RANDOM_TOOLCHANGER).
enum class Changer : std::uint8_t {
    FIXED,   ///< back to the pocket that it came from: T0 means no tool
    RANDOM,  ///< into the pocket that the new one leaves: T0 is a tool as any other
};

/// Highest pocket of a random changer; 0 is the spindle.
inline constexpr int MAX_POCKET = 1000;

/// Places are numbered: 0 is the spindle. FIXED: a copy of the loaded tool's entry, or toolno 0 when there is
/// none; 1 and on are the file's tools in its order. RANDOM: the place is the pocket, an empty one has toolno
/// -1, and the spindle's tool stands at 0 alone. Lengths in machine units. Not thread-safe.
class Table {
  public:
    explicit Table(Changer changer = Changer::FIXED);

    /// Errors name file, line and column; nothing is dropped silently.
    static Result<Table> load(const std::string &path);
    /// The first bad line is the error, and so is a tool that stands twice.
    static Result<Table> parse(std::string_view text, const std::string &path,
                               Changer changer = Changer::FIXED);
    /// Goes on: every bad line is skipped with a warning, which is safe, since a tool that is not there is
    /// refused where a program asks for it. A tool that stands twice counts with its first line, or not at
    /// all when the two have different figures; so do two tools in one pocket of a random changer. What looks
    /// wrong otherwise is warned of too.
    static Table parse_leniently(std::string_view text, const std::string &path, diagnostics::Sink &sink,
                                 Changer changer = Changer::FIXED);

    /// Writes atomically: lines of unchanged tools and comment lines stay as they were, but an older form is
    /// written anew as a whole.
    Result<> save(const std::string &path) const;
    std::string text() const;

    bool isRandom() const { return changer_ == Changer::RANDOM; }
    int count() const { return static_cast<int>(entries_.size()); }
    const ToolEntry &entry(int index) const { return entries_[static_cast<std::size_t>(index)]; }
    /// Index of tool `toolno`, at least 1, of a random changer at least 0; -1 when there is none.
    int index_of_tool(int toolno) const;
    int index_of_pocket(int pocketno) const;

    /// The tool's number and pocket stay. Index 0 of FIXED changes the spindle's copy only.
    void set_entry(int index, const ToolEntry &entry);
    void add(const ToolEntry &entry);
    /// Puts a new tool into its pocket; where that is 0, into the pocket of its own number or the lowest free
    /// one. Its index; an error when its number or pocket is taken, also by lines that cannot be used.
    Result<int> put(ToolEntry entry);
    /// The tool is gone, its lines too; the others keep their indices. An error for the one in the spindle.
    Result<> remove(int index);
    /// The tool at `index` is in the spindle from here on. FIXED: 0 means none. RANDOM: what was in the
    /// spindle is in its pocket then.
    void load_spindle(int index);

  private:
    struct Line {
        std::string text;
        int entry = NO_TOOL;  ///< index of its tool
        /// Tool and pocket of a line that is kept as text, as it contradicts another.
        std::optional<std::pair<int, int>> unused{};
        bool isChanged = false;
        bool isOldForm = false;
    };
    static constexpr int NO_TOOL = -1;
    struct ReadTool {
        ToolEntry entry;
        std::size_t line = 0;  ///< index in lines_
        bool isUsable = true;
    };
    struct Reading;
    void take_text(std::string_view text, Reading &reading);
    void take_tool(const Result<ToolEntry> &made, Reading &reading);
    void refuse_twice(Reading &reading) const;
    void check(Reading &reading) const;
    static void check_numbers(Reading &reading);
    void check_pockets(Reading &reading) const;
    void place(const Reading &reading);
    void clear_spindle();
    /// Who is in a pocket, -1: nobody.
    int owner_of(int pocketno) const;

    Changer changer_;
    std::vector<ToolEntry> entries_;
    std::vector<Line> lines_;
};

}  // namespace mw::tools

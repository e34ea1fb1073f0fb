// SPDX-License-Identifier: GPL-2.0-or-later
// The tool table: LinuxCNC's text file and the tool in the spindle.
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

/// The position to which a changer returns the tool from the spindle ([EMCIO]RANDOM_TOOLCHANGER).
enum class Changer : std::uint8_t {
    FIXED,   ///< back to its own pocket: T0 means no tool
    RANDOM,  ///< into the pocket of the new tool: T0 is an ordinary tool
};

/// Maximum pocket number of a random changer; 0 is the spindle.
inline constexpr int MAX_POCKET = 1000;

/// Entries have an index: 0 is the spindle. FIXED: entry 0 is a copy of the loaded tool's entry, or has
/// toolno 0; 1 and following are the tools of the file in order. RANDOM: the index is the pocket, an empty
/// one has toolno -1, and the tool in the spindle is only at 0. Lengths in machine units. Not thread-safe.
class Table {
  public:
    explicit Table(Changer changer = Changer::FIXED);

    /// Errors name file, line and column; nothing is ignored silently.
    static Result<Table> load(const std::string &path);
    /// The first invalid line, or a tool that occurs twice, is an error.
    static Result<Table> parse(std::string_view text, const std::string &path,
                               Changer changer = Changer::FIXED);
    /// Skips each invalid line with a warning. That is safe, because a program that requires a missing tool
    /// is rejected. For a tool that occurs twice the first line counts, or none when they differ; likewise
    /// for two tools in one pocket of a random changer. Also warns of doubtful lines.
    static Table parse_leniently(std::string_view text, const std::string &path, diagnostics::Sink &sink,
                                 Changer changer = Changer::FIXED);

    /// Writes atomically: lines of unchanged tools and comment lines are kept, but a table in an older form
    /// is rewritten completely.
    Result<> save(const std::string &path) const;
    std::string text() const;

    bool isRandom() const { return changer_ == Changer::RANDOM; }
    int count() const { return static_cast<int>(entries_.size()); }
    const ToolEntry &entry(int index) const { return entries_[static_cast<std::size_t>(index)]; }
    /// Index of tool `toolno`, at least 1, with a random changer at least 0; -1 when there is none.
    int index_of_tool(int toolno) const;
    int index_of_pocket(int pocketno) const;

    /// Number and pocket of the tool do not change. Index 0 of FIXED changes only the copy in the spindle.
    void set_entry(int index, const ToolEntry &entry);
    void add(const ToolEntry &entry);
    /// Puts a new tool into its pocket; if that is 0, into the pocket with the tool's number or the lowest
    /// free one. Returns its index; an error when its number or pocket is in use, also by lines that are not
    /// usable.
    Result<int> put(ToolEntry entry);
    /// Removes the tool and its lines; the others keep their indices. An error for the tool in the spindle.
    Result<> remove(int index);
    /// Loads the tool at `index` into the spindle. FIXED: 0 means none. RANDOM: the previous tool goes to the
    /// pocket.
    void load_spindle(int index);

  private:
    struct Line {
        std::string text;
        int entry = NO_TOOL;  ///< index of its tool
        /// Tool and pocket of a line that is kept as text because it contradicts another line.
        std::optional<std::pair<int, int>> unused{};
        bool changed = false;
        bool is_old_form = false;
    };
    static constexpr int NO_TOOL = -1;
    struct ReadTool {
        ToolEntry entry;
        std::size_t line = 0;  ///< index in lines_
        bool usable = true;
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
    /// Tool in a pocket, -1: none.
    int owner_of(int pocketno) const;

    Changer changer_;
    std::vector<ToolEntry> entries_;
    std::vector<Line> lines_;
};

}  // namespace mw::tools

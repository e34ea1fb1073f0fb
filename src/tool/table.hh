// SPDX-License-Identifier: GPL-2.0-or-later
// The tool table: the classic text file and what is in the spindle.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "base/result.hh"
#include "diag/sink.hh"
#include "tool/entry.hh"

namespace mw::tool {

/// Tools with fixed places (not a random changer). Index 0 is the spindle: a copy of the loaded tool's entry,
/// or toolno 0 when there is none; 1 and on are the file's entries in its order. Not thread-safe. File: one
/// tool per line, "T1 P1 X0 Y0 Z+0.511 A B C U V W D0.125 I J Q ;comment"; lengths in machine units.
class Table {
  public:
    Table() : entries_(1) { clear_spindle(); }

    /// Errors name file, line and column; nothing is dropped silently.
    static Result<Table> load(const std::string &path);
    /// The first bad line is the error, and so is a tool that stands twice.
    static Result<Table> parse(std::string_view text, const std::string &path);
    /// Goes on: every bad line is skipped with a warning, which is safe, since a tool that is not there is
    /// refused where a program asks for it. A tool that stands twice counts with its first line, or not at
    /// all when the two have different figures. What looks wrong otherwise is warned of too.
    static Table parse_leniently(std::string_view text, const std::string &path, diag::Sink &sink);

    /// Writes atomically: lines of unchanged tools and comment lines stay as they were.
    Result<> save(const std::string &path) const;
    std::string text() const;

    int count() const { return static_cast<int>(entries_.size()); }
    const ToolEntry &entry(int index) const { return entries_[static_cast<std::size_t>(index)]; }
    /// Index of tool `toolno`, at least 1; -1 when there is none.
    int index_of_tool(int toolno) const;
    int index_of_pocket(int pocketno) const;

    /// Index 0 changes the spindle's copy only.
    void set_entry(int index, const ToolEntry &entry);
    void add(const ToolEntry &entry);
    /// The tool at `index` is in the spindle from here on; 0: none.
    void load_spindle(int index);

  private:
    struct Line {
        std::string text;
        int entry = 0;  ///< index of its tool, 0 for a line without one
        bool isChanged = false;
    };
    void clear_spindle();
    /// Takes the good lines, and all as text; what is wrong with the others.
    std::vector<Error> take_lines(std::string_view text, const std::string &path);
    void check(const std::string &path, diag::Sink &sink);
    void check_twice(std::size_t later, const std::vector<int> &line_of, const std::string &path,
                     diag::Sink &sink);

    std::vector<ToolEntry> entries_;
    std::vector<Line> lines_;
};

/// One line as the file has it.
std::string format_entry(const ToolEntry &entry);

}  // namespace mw::tool

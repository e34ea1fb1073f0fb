// SPDX-License-Identifier: GPL-2.0-or-later
// The tool table of a machine whose tools return to their pockets (requirements G1, G2), and its file.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "base/result.hh"
#include "tool/entry.hh"

namespace mw::tool {

/// Entry 0 is the tool in the spindle, the others are the lines of the file in their order. One thread.
class Table {
  public:
    /// Reads a table: `T1 P1 D6.0 Z+40.0 ... ;comment` a line, words in any order. Every line is kept or
    /// refused with line and column: unknown or repeated words, bad numbers, missing or doubled tool numbers,
    /// T0.
    static Result<Table> parse(std::string_view text, const std::string &path);
    /// The text of the file: comment lines in their places, words of zero left out.
    std::string format() const;

    int count() const { return static_cast<int>(entries_.size()); }
    const ToolEntry &entry(int index) const { return entries_[static_cast<std::size_t>(index)]; }
    /// -1 when the table has no such tool.
    int index_of_tool(int toolno) const;

    /// Copies entry `index` into the spindle; 0 empties it.
    void load_spindle(int index);
    /// Changes an entry; one that describes the tool in the spindle changes the spindle's copy too (G4).
    void set_entry(int index, const ToolEntry &entry);

  private:
    struct TextLine {
        int index = 0;        ///< entry of this line; 0: a line of comment or blank
        std::string comment;  ///< the whole line when index is 0
    };

    std::vector<ToolEntry> entries_{ToolEntry{}};
    std::vector<TextLine> lines_;
};

}  // namespace mw::tool

// SPDX-License-Identifier: GPL-2.0-or-later
// One line of a tool table as text: "T1 P17 X0 Z+0.511 D0.125 I J Q ;remark", and the older forms with
// columns below a header: "POC FMS LEN DIAM COMMENT" for mills, "POC FMS ZOFF XOFF DIAM FRONTANGLE BACKANGLE
// ORIENT" for lathes, also with TOOLNO and POCKET.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.hh"
#include "gcode/tools/entry.hh"

namespace mw::tools {

/// Meaning of each column of an older table, as the letter of a word.
using Columns = std::vector<char>;

/// Columns of tables for mills, the default without a header.
const Columns &columns_of_mills();
/// The columns that a header of an older table names, without its comment's.
std::optional<Columns> columns_of_header(std::string_view line);
/// A line of numbers in columns, as in older tables.
bool isInColumns(std::string_view line);
/// The line has more than a comment.
bool hasTool(std::string_view line);

/// A tool whose line has no P word has pocket NO_POCKET. Errors name file, line and column.
inline constexpr int NO_POCKET = -1;
Result<ToolEntry> parse_line(std::string_view line, const SourcePlace &place);
Result<ToolEntry> parse_columns(std::string_view line, const Columns &columns, const SourcePlace &place);

/// The entry as a line of the file.
std::string format_entry(const ToolEntry &entry);

}  // namespace mw::tools

// SPDX-License-Identifier: GPL-2.0-or-later
// One line of a tool table as text: "T1 P17 X0 Z+0.511 D0.125 I J Q ;remark", and the older forms of columns
// below a header: "POC FMS LEN DIAM COMMENT" of mills, "POC FMS ZOFF XOFF DIAM FRONTANGLE BACKANGLE ORIENT"
// of lathes, also with TOOLNO and POCKET.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.hh"
#include "gcode/tools/entry.hh"

namespace mw::tools {

/// What a column of an older table stands for: a letter as in a line of words.
using Columns = std::vector<char>;

/// Of mills, where no header says otherwise.
const Columns &columns_of_mills();
/// The line names columns: a header of an older table, without its remark's.
std::optional<Columns> columns_of_header(std::string_view line);
/// A line of numbers, as older tables have them.
bool isInColumns(std::string_view line);
/// There is more in it than a remark.
bool hasTool(std::string_view line);

/// A tool whose line has no P word has pocket NO_POCKET. Errors name file, line and column.
inline constexpr int NO_POCKET = -1;
Result<ToolEntry> parse_line(std::string_view line, const SourcePlace &place);
Result<ToolEntry> parse_columns(std::string_view line, const Columns &columns, const SourcePlace &place);

/// One line as the file has it.
std::string format_entry(const ToolEntry &entry);

}  // namespace mw::tools

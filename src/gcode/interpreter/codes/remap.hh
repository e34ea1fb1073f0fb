// SPDX-License-Identifier: GPL-2.0-or-later
// Codes that are remapped to a subroutine or a script: [RS274NGC]REMAP.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "base/result.hh"
#include "gcode/interpreter/codes/block_values.hh"
#include "gcode/interpreter/interpreter.hh"
#include "gcode/interpreter/scripts/script_host.hh"

namespace mw::gcode::detail {

/// A word of the argspec.
struct RemapWord {
    char letter = 'p';  ///< lower case
    bool required = false;
};

struct Remap {
    std::string name;  ///< in upper case: "M400", "G88.1"
    Code code;         ///< row in the table of codes
    int modal_group = 0;
    std::string ngc;               ///< name of the subroutine; or
    std::string function;          ///< or the script's function (py=, python=)
    std::string prolog, epilog;    ///< script functions around the subroutine
    std::string argspec;           ///< as written
    std::vector<RemapWord> words;  ///< in the order of the argspec
    bool positional = false;       ///< @: words become #1, #2, ...
    bool needs_feed = false;       ///< >
    bool needs_speed = false;      ///< ^
    bool wants_line = false;       ///< n: the line number becomes #<n>
    SourcePlace place;
    std::string refusal;  ///< why the line has no effect

    bool needsScripts() const { return !function.empty() || !prolog.empty() || !epilog.empty(); }
    /// Name of the procedure in messages.
    const std::string &target() const { return ngc.empty() ? function : ngc; }
    ScriptRemap described() const;
};

/// A block that waits for the subroutine of one of its codes.
struct PendingBlock {
    const Remap *remap = nullptr;  ///< remap of that code
    BlockValues values;
    std::size_t next = 0;  ///< index of the code to continue with
    std::string comment;
    int line = 0, sequence = -1;
};

/// Reads one REMAP line, as in "M400 modalgroup=5 argspec=PQ ngc=rm400". Errors name file, line and column.
Result<Remap> parse_remap(const RemapLine &line);

}  // namespace mw::gcode::detail

// SPDX-License-Identifier: GPL-2.0-or-later
// Search for subroutines: in the current file, in its callers, or in a separate file.
#pragma once

#include <string>
#include <vector>

#include "gcode/interpreter/flow/levels.hh"
#include "gcode/interpreter/flow/program_files.hh"
#include "gcode/syntax/fault.hh"

namespace mw::gcode::detail {

/// A subroutine's first line.
struct Sub {
    Program *program = nullptr;
    int line = 0;
};

struct SubSearch {
    const Levels &levels;
    ProgramFiles &files;
    Names &names;
    const std::vector<std::string>
        &folders;  ///< folders of separate files, after the folder of the main program
    Fault &fault;
    bool confined = false;  ///< names with '..' match no file
};

/// `O<label> sub`. False after setting the fault; `column` of the call.
bool find_sub(NameId label, std::uint32_t column, const SubSearch &search, Sub &sub);
/// A label without `sub`, for M98.
bool find_fanuc_sub(NameId label, const SubSearch &search, Sub &sub);
/// Hint for errors in a subroutine: its name and the position of its call.
std::string called_from(NameId label, const Levels &levels, const Names &names);

// Scripts compare these texts, including the dots.
inline constexpr char FANUC_TEXT[] = "Fanuc 'O....' subroutine must be called with 'M98'";
inline constexpr char FANUC_END_TEXT[] = "Fanuc 'O....' subroutine definition must end with 'M99'";
inline constexpr char OWORD_TEXT[] = "'O.... sub' subroutine must be called with 'O.... call'";
inline constexpr char OWORD_END_TEXT[] =
    "'O.... endsub' or 'O.... return' must follow 'O.... sub' subroutine definition";

}  // namespace mw::gcode::detail

// SPDX-License-Identifier: GPL-2.0-or-later
// Where subroutines are: in the file that runs, in those that have called it, or in a file of their own.
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
    const std::vector<std::string> &folders;  ///< for files of their own, after that of the main program
    Fault &fault;
    bool isConfined = false;  ///< names with '..' find no file
};

/// `O<label> sub`. False after setting the fault; `column` of the call.
bool find_sub(NameId label, std::uint32_t column, const SubSearch &search, Sub &sub);
/// The label alone, as M98 calls it.
bool find_fanuc_sub(NameId label, const SubSearch &search, Sub &sub);
/// Advice for errors that are about a subroutine: which, and where it was called.
std::string called_from(NameId label, const Levels &levels, const Names &names);

// Scripts compare these texts, dots and all.
inline constexpr char FANUC_TEXT[] = "Fanuc 'O....' subroutine must be called with 'M98'";
inline constexpr char FANUC_END_TEXT[] = "Fanuc 'O....' subroutine definition must end with 'M99'";
inline constexpr char OWORD_TEXT[] = "'O.... sub' subroutine must be called with 'O.... call'";
inline constexpr char OWORD_END_TEXT[] =
    "'O.... endsub' or 'O.... return' must follow 'O.... sub' subroutine definition";

}  // namespace mw::gcode::detail

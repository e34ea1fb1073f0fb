// SPDX-License-Identifier: GPL-2.0-or-later
// Maximum nesting of a Tcl script: Tcl uses one level of its stack for each nested command, and ends the
// process when the stack is exhausted.
#pragma once

#include <tcl.h>

#include <string>
#include <string_view>

#include "base/result.hh"

namespace mw::hal::tcl {

/// An error if more than 1000 `[` and `$name(` are nested; `path` is for its position.
Result<> check_nesting(std::string_view script, const std::string &path);

/// As check_nesting(), for a file. If the file cannot be read, Tcl reports it.
Result<> check_nesting_of_file(const std::string &path);

/// Makes the Tcl command `source` check each file first.
void add_source_limits(Tcl_Interp *interpreter);

}  // namespace mw::hal::tcl

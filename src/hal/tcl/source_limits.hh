// SPDX-License-Identifier: GPL-2.0-or-later
// How deeply a script of Tcl may nest: Tcl parses commands within commands with one level of its stack for
// each, and ends the process when that is used up.
#pragma once

#include <tcl.h>

#include <string>
#include <string_view>

#include "base/result.hh"

namespace mw::hal::tcl {

/// An error where more than 1000 `[` and `$name(` are open in one another; `path` is for its place.
Result<> check_nesting(std::string_view script, const std::string &path);

/// As check_nesting(), for a file. A file that cannot be read is no error here: Tcl reports it.
Result<> check_nesting_of_file(const std::string &path);

/// Makes `source` check each file first.
void add_source_limits(Tcl_Interp *interpreter);

}  // namespace mw::hal::tcl

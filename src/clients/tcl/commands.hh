// SPDX-License-Identifier: GPL-2.0-or-later
// The commands emc_*: one row for each.
#pragma once

#include <span>
#include <string>

#include "clients/tcl/shell.hh"

namespace mw::tcl {

/// Takes the words after the name and returns the result. An error is an error of the Tcl program.
using Handler = Result<std::string> (*)(Shell &, const Words &);

struct CommandRow {
    const char *name;
    int least, most;    ///< minimum and maximum number of words after the name
    const char *usage;  ///< usage of these words
    Handler handler;
};

/// Values of the status; some commands also set them.
std::span<const CommandRow> questions();
/// Orders; most of them return the current value if called without words.
std::span<const CommandRow> orders();
/// Commands for the INI file, the connection, and number formats.
std::span<const CommandRow> settings();

}  // namespace mw::tcl

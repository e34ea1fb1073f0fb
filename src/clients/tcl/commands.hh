// SPDX-License-Identifier: GPL-2.0-or-later
// The commands emc_*: a row for each.
#pragma once

#include <span>
#include <string>

#include "clients/tcl/shell.hh"

namespace mw::tcl {

/// The words behind the name; the result. An error is one of the Tcl program.
using Handler = Result<std::string> (*)(Shell &, const Words &);

struct CommandRow {
    const char *name;
    int least, most;    ///< words behind the name
    const char *usage;  ///< those words
    Handler handler;
};

/// Values of the status; some also set it.
std::span<const CommandRow> questions();
/// Orders; without words most of them return the current value.
std::span<const CommandRow> orders();
/// The INI file, the connection, numbers.
std::span<const CommandRow> settings();

}  // namespace mw::tcl

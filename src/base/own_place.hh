// SPDX-License-Identifier: GPL-2.0-or-later
// Finds the folder of this program, and files relative to it.
#pragma once

#include <string>

namespace mw {

/// The folder of the running program's file; "." when the system does not report it.
std::string program_folder();

/// A program that runs out of memory reports it and ends with status 1 instead of calling std::terminate. For
/// the whole process; call it once, from main().
void tell_when_memory_ends() noexcept;

/// Calls tell_when_memory_ends(), and puts our programs first in PATH, our Python modules first in PYTHONPATH
/// and our Tcl packages first in TCLLIBPATH. So programs started from here (loadusr, displays) find those of
/// this version. Call it once at the start, while there is one thread.
void offer_own_programs();

}  // namespace mw

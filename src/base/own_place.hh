// SPDX-License-Identifier: GPL-2.0-or-later
// Where this program lies, and what lies around it.
#pragma once

#include <string>

namespace mw {

/// The folder of the running program's file; "." when the system does not say.
std::string program_folder();

/// From now on a program that gets no memory says so and ends with status 1, instead of std::terminate. For
/// the whole process, once, from main().
void tell_when_memory_ends() noexcept;

/// Calls tell_when_memory_ends(), and puts our programs first in PATH, our Python modules first in PYTHONPATH
/// and our Tcl packages first in TCLLIBPATH, so that programs started from here (loadusr, displays) find
/// those of this version. Call it once at the start, while there is one thread.
void offer_own_programs();

}  // namespace mw

// SPDX-License-Identifier: GPL-2.0-or-later
// Where this program lies, and what lies around it.
#pragma once

#include <string>

namespace mw {

/// The folder of the running program's file; "." when the system does not say.
std::string program_folder();

/// Puts our programs first in PATH and our Python modules first in PYTHONPATH, so that programs started from
/// here (loadusr, displays) find those of this version. Call it once at the start, while there is one thread.
void offer_own_programs();

}  // namespace mw

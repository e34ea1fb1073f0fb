// SPDX-License-Identifier: GPL-2.0-or-later
// The programs inivar and inivalue: one value of an INI file, for scripts.
#pragma once

#include <string>
#include <vector>

namespace mw::ini {

struct ProgramOutput {
    int status = 0;
    std::string out, err;
};

/// inivar -var NAME [-sec SECTION] [-num N] [-ini FILE] [-tildeexpand]: the words after the program's name.
/// Status 0 found, 1 not found or wrong usage, 255 no such file. The messages are LinuxCNC's.
ProgramOutput run_inivar(const std::vector<std::string> &words);

/// inivalue [OPTIONS] FILE: see USAGE in the source. Values can be checked for a type and a range and have a
/// default.
ProgramOutput run_inivalue(const std::vector<std::string> &words);

}  // namespace mw::ini

// SPDX-License-Identifier: GPL-2.0-or-later
// The files of a planned machine.
#pragma once

#include <string>
#include <vector>

#include "machine/setup/plan.hh"

namespace mw::setup {

struct File {
    std::string name;  ///< in the machine's folder: "machine.ini", "nc_files/first_program.ngc"
    std::string text;

    bool operator==(const File &) const = default;
};

inline constexpr const char *INI_FILE = "machine.ini", *PROGRAM_FILE = "nc_files/first_program.ngc";

/// All files of the machine, the INI file first; comments in each explain its purpose. `plan` must be free of
/// faults.
std::vector<File> machine_files(const Plan &plan);

std::string ini_text(const Plan &plan);
/// One HAL file for each function of the machine, in the order in which they are run.
std::vector<File> hal_files(const Plan &plan);
std::string tool_table_text(const Plan &plan);
/// Moves each axis through the middle of its travel, within the limits.
std::string program_text(const Plan &plan);

}  // namespace mw::setup

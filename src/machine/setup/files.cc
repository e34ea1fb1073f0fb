// SPDX-License-Identifier: GPL-2.0-or-later
#include "machine/setup/files.hh"

namespace mw::setup {

std::vector<File> machine_files(const Plan &plan) {
    std::vector<File> files{{INI_FILE, ini_text(plan)}, {"machine.hal", hal_text(plan)}};
    if (plan.is_stepper) {
        files.push_back({"simulated_wires.hal", wires_text(plan)});
    }
    files.push_back({"tool.tbl", tool_table_text(plan)});
    files.push_back({PROGRAM_FILE, program_text(plan)});
    return files;
}

}  // namespace mw::setup

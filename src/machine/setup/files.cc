// SPDX-License-Identifier: GPL-2.0-or-later
#include "machine/setup/files.hh"

#include <iterator>

#include "machine/setup/detail/hal_parts.hh"

namespace mw::setup {

std::vector<File> machine_files(const Plan &plan) {
    std::vector<File> files{{INI_FILE, ini_text(plan)}};
    std::vector<File> hal = hal_files(plan);
    files.insert(files.end(), std::make_move_iterator(hal.begin()), std::make_move_iterator(hal.end()));
    if (plan.hasBoard() && plan.board != Board::PARPORT) {
        files.push_back({detail::MOTORS_FILE, detail::simulated_motors_text(plan)});
    }
    files.push_back({"tool.tbl", tool_table_text(plan)});
    files.push_back({PROGRAM_FILE, program_text(plan)});
    return files;
}

}  // namespace mw::setup

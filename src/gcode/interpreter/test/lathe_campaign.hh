// SPDX-License-Identifier: GPL-2.0-or-later
// Runs turning jobs through the interpreter and judges its moves on simulated stock.
#pragma once

#include <string>

#include "tests/support/stock/lathe_job.hh"

namespace mw::gcode::test {

struct LatheVerdict {
    std::string refusal;  ///< the interpreter's error without numbers; nothing if the program was accepted
    std::string fault;    ///< fault of the moves, or of the remaining material
    std::size_t moves = 0;
    std::vector<testing::Place> last_places;  ///< after each G4 P0: end of the last feed move
};

LatheVerdict run_lathe_job(const testing::LatheJob &job);

}  // namespace mw::gcode::test

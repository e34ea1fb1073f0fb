// SPDX-License-Identifier: GPL-2.0-or-later
// Runs turning jobs through the interpreter and judges its moves on simulated stock.
#pragma once

#include <string>

#include "tests/support/stock/lathe_job.hh"

namespace mw::gcode::test {

struct LatheVerdict {
    std::string refusal;  ///< the interpreter's, without figures; nothing when it has run
    std::string fault;    ///< what is wrong with the moves, or with what is left
    std::size_t moves = 0;
    std::vector<testing::Place> last_places;  ///< after each G4 P0: the last one fed to
};

LatheVerdict run_lathe_job(const testing::LatheJob &job);

}  // namespace mw::gcode::test

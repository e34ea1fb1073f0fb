// SPDX-License-Identifier: GPL-2.0-or-later
// Report from the recorded cycles of Ethernet boards: the reasons why packets arrive late, and the remedies.
#pragma once

#include <cstdint>

#include "base/diagnostics/sink.hh"
#include "drivers/mesa/ethernet/cycle_record_file.hh"

namespace mw::doctor {

/// Reports one finding for each cause in the records of this user's boards.
void examine_boards(diagnostics::Sink &sink);

/// Findings for one board; `now_ns` is monotonic.
void judge_board(const mesa::RecordedCycles &cycles, std::int64_t now_ns, diagnostics::Sink &sink);

}  // namespace mw::doctor

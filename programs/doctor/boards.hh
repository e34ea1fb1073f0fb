// SPDX-License-Identifier: GPL-2.0-or-later
// What the recorded cycles of Ethernet boards show: who was late, and what to change.
#pragma once

#include <cstdint>

#include "base/diagnostics/sink.hh"
#include "drivers/mesa/ethernet/cycle_record_file.hh"

namespace mw::doctor {

/// One finding for each cause in the records of this user's boards.
void examine_boards(diagnostics::Sink &sink);

/// The same of one board; `now_ns` is monotonic.
void judge_board(const mesa::RecordedCycles &cycles, std::int64_t now_ns, diagnostics::Sink &sink);

}  // namespace mw::doctor

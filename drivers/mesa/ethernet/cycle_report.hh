// SPDX-License-Identifier: GPL-2.0-or-later
// Report from the recorded cycles of a board, which shows whether the thread, the kernel, the network or the
// board was late.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "drivers/mesa/ethernet/cycle_ring.hh"

namespace mw::mesa {

/// Statistics of a time over all cycles [ns].
struct TimeFigures {
    std::int64_t median_ns = 0, p999_ns = 0, max_ns = 0;
};

/// Statistics of cycles.
struct CycleFigures {
    std::size_t cycles = 0;
    std::int64_t period_ns = 0;
    TimeFigures late;             ///< delay of the start of a cycle
    TimeFigures send;             ///< duration until the kernel has accepted the request
    TimeFigures answer;           ///< from the request to its answer
    TimeFigures gap;              ///< between two writes
    std::size_t late_cycles = 0;  ///< number of cycles that began more than half a period late
    std::size_t no_answer = 0, send_failed = 0, receive_failed = 0, short_answer = 0, write_lost = 0;
    std::size_t late_answers = 0;    ///< number of answers after the deadline
    std::int64_t lost_to_board = 0;  ///< number of packets that the board has not received
    int error = 0;                   ///< the last errno

    std::size_t failures() const {
        return no_answer + send_failed + receive_failed + short_answer + write_lost;
    }
};

/// `cycles` are in order, oldest first.
CycleFigures figures_of(std::span<const CycleTimes> cycles, std::int64_t period_ns);

/// A cause, its evidence, and what to change.
struct CycleCause {
    std::string cause, remedy;
};

/// The causes of failures and of long times, the most probable first; empty: all cycles were good.
std::vector<CycleCause> causes_of(const CycleFigures &figures);

}  // namespace mw::mesa

// SPDX-License-Identifier: GPL-2.0-or-later
// A long call of the program reader, and the data that other threads may read meanwhile.
#pragma once

#include <cstdint>
#include <optional>

#include "machine/task/run/long_call.hh"
#include "machine/task/sequencer/sequencer.hh"

namespace mw::task {

struct ReaderCall {
    LongCall call;
    ItemQueue fresh;  ///< calls of the step, queued when the call ends
    std::uint64_t reads_before = 0;
    std::optional<std::uint64_t> fixed_executed;

    /// Called when the work is being stopped: the blocks executed until now count, whatever the call still
    /// reads.
    void fix_executed(const Sequencer &sequencer) {
        if (!fixed_executed.has_value()) {
            fixed_executed = sequencer.isIdle() ? reads_before : sequencer.place().read;
        }
    }
};

}  // namespace mw::task

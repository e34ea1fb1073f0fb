// SPDX-License-Identifier: GPL-2.0-or-later
// A call of the program reader that takes long, and what another thread may know of it meanwhile.
#pragma once

#include <cstdint>
#include <optional>

#include "machine/task/run/long_call.hh"
#include "machine/task/sequencer/sequencer.hh"

namespace mw::task {

struct ReaderCall {
    LongCall call;
    ItemQueue fresh;  ///< what it asks of the machine: queued at its end
    std::uint64_t reads_before = 0;
    std::optional<std::uint64_t> fixed_executed;

    /// The work is stopped meanwhile: what the machine has executed by now counts, whatever the call still
    /// reads.
    void fix_executed(const Sequencer &sequencer) {
        if (!fixed_executed.has_value()) {
            fixed_executed = sequencer.isIdle() ? reads_before : sequencer.place().read;
        }
    }
};

}  // namespace mw::task

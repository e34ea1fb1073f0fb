// SPDX-License-Identifier: GPL-2.0-or-later
// The function lists of threads. A process that changes a list fills the spare list, switches the lists, and
// waits until the cycle that may use the old list has ended. The caller holds the segment's lock and runs
// outside of HAL threads.
#pragma once

#include <algorithm>

#include "base/result.hh"
#include "hal/core/detail/segment.hh"

namespace mw::hal::detail {

const FunctionList &active_list(const Segment &segment, const ThreadRecord &thread) noexcept;

/// Waits until the functions of the current cycle have ended.
void wait_for_cycle(const Segment &segment, const ThreadRecord &thread) noexcept;

/// Copies the thread's list into the spare list. It is an error inside of a HAL thread.
Result<FunctionList *> begin_change(const Segment &segment, ThreadRecord &thread);
/// The thread uses the spare list from its next period on. On return the old list is no longer in use.
void end_change(const Segment &segment, ThreadRecord &thread) noexcept;

/// Applies `change` to a copy of the list, and uses it unless `change` fails.
template <class Change>
Result<> change_list(const Segment &segment, ThreadRecord &thread, Change change) {
    auto spare = begin_change(segment, thread);
    if (!spare) {
        return std::unexpected(spare.error());
    }
    if (auto changed = change(**spare); !changed) {
        return changed;
    }
    end_change(segment, thread);
    return {};
}

/// Removes a function from all threads.
void drop_from_lists(const Segment &segment, Offset funct) noexcept;

}  // namespace mw::hal::detail

// SPDX-License-Identifier: GPL-2.0-or-later
// What a trial says of a plan.
#pragma once

#include "trajectory/path_store.hh"

namespace mw::trajectory {

struct Verdict {
    bool isSound = true;
    std::uint64_t tick = 0;  ///< of the failed sample
};

/// The pieces that a failed sample depends on and that are not driven yet; 0: none.
struct Cause {
    Sequence low = 0, high = 0;
    bool isAfterDriven = false;  ///< it depends on what has been driven already, too
};

}  // namespace mw::trajectory

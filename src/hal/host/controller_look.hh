// SPDX-License-Identifier: GPL-2.0-or-later
// The host's look at the controlling process, by a thread of the same priority.
#pragma once

#include <cstdint>

#include "hal/core/detail/impl.hh"

namespace mw::hal {

/// One thread.
class ControllerLook {
  public:
    /// Counts a look for modules that want to know (mw_ext_count_looks). Once the process `pid` hangs and its
    /// machine is off, coolant and whatever else it has switched on go off. 0: there is none.
    void step(Hal::Impl &hal, std::int32_t pid);

  private:
    /// A computer that gives the controlling process no time gives this thread none either.
    void take_priority_of(std::int32_t pid);

    int policy_ = 0;  ///< of the process; SCHED_OTHER
    bool isHung_ = false;
};

}  // namespace mw::hal

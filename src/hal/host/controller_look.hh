// SPDX-License-Identifier: GPL-2.0-or-later
// The host's check of the controlling process, by a thread of the same priority.
#pragma once

#include <cstdint>

#include "hal/core/instance.hh"

namespace mw::hal {

/// The check of one thread.
class ControllerLook {
  public:
    /// Counts a check for modules that use it (mw_ext_count_looks). When the process `pid` hangs and its
    /// machine is off, switches off coolant and its other outputs. 0: there is no controlling process.
    void step(Instance &hal, std::int32_t pid);

  private:
    /// Takes the priority of the controlling process, so that load delays both equally.
    void take_priority_of(std::int32_t pid);

    int policy_ = 0;  ///< scheduling policy of the process; SCHED_OTHER
    bool hung_ = false;
};

}  // namespace mw::hal

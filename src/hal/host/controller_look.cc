// SPDX-License-Identifier: GPL-2.0-or-later
#include "hal/host/controller_look.hh"

#include <sched.h>

#include "base/thread_priority.hh"

namespace mw::hal {

void ControllerLook::take_priority_of(std::int32_t pid) {
    const int got = pid > 0 ? ::sched_getscheduler(pid) : -1;
    const int policy = got < 0 ? SCHED_OTHER : got & ~SCHED_RESET_ON_FORK;
    if (policy != policy_) {
        policy_ = policy;
        policy == SCHED_RR ? raise_priority() : reset_priority();
    }
}

void ControllerLook::step(Instance &hal, std::int32_t pid) {
    take_priority_of(pid);
    ControllerWatches &watches = hal.controller_watches();
    watches.count_check();
    const bool hung = pid > 0 && !watches.isEmpty() && watches.isSafe();
    if (hung && !hung_) {
        hal.processes().set_safe_outputs(pid);
    }
    hung_ = hung;
}

}  // namespace mw::hal

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

void ControllerLook::step(Hal::Impl &hal, std::int32_t pid) {
    take_priority_of(pid);
    bool hung = pid > 0 && !hal.controller_watches.empty();
    for (const auto &watch : hal.controller_watches) {
        if (watch.looks != nullptr) {
            __atomic_fetch_add(watch.looks, 1U, __ATOMIC_RELAXED);
        }
        hung = hung && __atomic_load_n(watch.is_safe, __ATOMIC_ACQUIRE) != 0;
    }
    if (hung && !hung_) {
        hal.rest_process(pid);
    }
    hung_ = hung;
}

}  // namespace mw::hal

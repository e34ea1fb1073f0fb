// SPDX-License-Identifier: GPL-2.0-or-later
#include "base/thread_priority.hh"

#include <sched.h>
#include <sys/resource.h>
#include <unistd.h>

namespace mw {
namespace {

void set_nice(int thread_id, int value) noexcept {
    const int thread = thread_id != 0 ? thread_id : ::gettid();
    static_cast<void>(::setpriority(PRIO_PROCESS, static_cast<id_t>(thread), value));
}

bool set_policy(int thread_id, int policy, int priority) noexcept {
    sched_param parameters{};
    parameters.sched_priority = priority;
    return ::sched_setscheduler(thread_id, policy | SCHED_RESET_ON_FORK, &parameters) == 0;
}

}  // namespace

void raise_priority(int thread_id) noexcept {
    constexpr int NICE = -10;
    if (!set_policy(thread_id, SCHED_RR, 1)) {
        set_policy(thread_id, SCHED_OTHER, 0);
        set_nice(thread_id, NICE);
    }
}

void reset_priority(int thread_id) noexcept {
    set_policy(thread_id, SCHED_OTHER, 0);
    set_nice(thread_id, 0);
}

void lower_priority(int thread_id) noexcept {
    constexpr int NICE = 10;
    set_nice(thread_id, NICE);
}

}  // namespace mw

// SPDX-License-Identifier: GPL-2.0-or-later
#include "messages/mailbox/process_watch.hh"

#include <pthread.h>
#include <signal.h>

#include <algorithm>
#include <chrono>

#include "messages/mailbox/memory.hh"

namespace mw::mailbox {

ProcessWatch::~ProcessWatch() {
    if (thread_.joinable()) {
        isEnding_ = true;
        count_.fetch_add(1);
        count_.notify_one();
        thread_.join();
    }
}

ProcessWatch::State ProcessWatch::state_of(std::uint64_t owner) {
    auto found = std::ranges::find_if(watched_, [owner](const Watched &one) { return one.owner == owner; });
    if (found != watched_.end()) {
        return found->state.load(std::memory_order_acquire);
    }
    found = std::ranges::find_if(watched_, [](const Watched &one) { return one.owner == 0; });
    if (found == watched_.end()) {
        return State::RUNNING;  // cannot happen: there are no more clients than slots
    }
    found->state.store(State::RUNNING, std::memory_order_relaxed);
    found->owner.store(owner, std::memory_order_release);
    count_.fetch_add(1);
    count_.notify_one();
    if (!thread_.joinable()) {
        thread_ = std::thread([this] { run(); });
    }
    return State::RUNNING;
}

void ProcessWatch::forget(std::uint64_t owner) {
    const auto found =
        std::ranges::find_if(watched_, [owner](const Watched &one) { return one.owner == owner; });
    if (owner != 0 && found != watched_.end()) {
        found->owner.store(0, std::memory_order_release);
        count_.fetch_sub(1);
    }
}

void ProcessWatch::run() {
    sigset_t all;
    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, nullptr);  // signals are handled by the thread that runs the machine
    std::array<std::uint64_t, MAX_CLIENTS> stopped_before{};
    while (!isEnding_) {
        count_.wait(0);
        for (std::size_t i = 0; i < watched_.size(); ++i) {
            Watched &one = watched_[i];
            const std::uint64_t owner = one.owner.load(std::memory_order_acquire);
            if (owner == 0) {
                continue;
            }
            const runtime::Activity activity = activity_of(owner);
            const bool stopped = activity == runtime::Activity::STOPPED;
            State state = activity == runtime::Activity::ENDED ? State::ENDED : State::RUNNING;
            // A debugger or tracer stops a process many times a second, but only briefly.
            state = stopped && stopped_before[i] == owner ? State::STOPPED : state;
            stopped_before[i] = stopped ? owner : 0;
            if (one.owner.load(std::memory_order_acquire) == owner) {
                one.state.store(state, std::memory_order_release);
            }
        }
        std::this_thread::sleep_for(std::chrono::nanoseconds(PERIOD_NS));
    }
}

}  // namespace mw::mailbox

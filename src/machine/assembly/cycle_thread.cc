// SPDX-License-Identifier: GPL-2.0-or-later
#include "machine/assembly/cycle_thread.hh"

#include <unistd.h>

#include <chrono>

#include "base/thread_priority.hh"

namespace mw::machine {
namespace {

/// Outside of long calls task does not wait, so it soon ends its cycle or begins a call.
constexpr std::chrono::milliseconds LOOK_AGAIN{1};

}  // namespace

CycleThread::CycleThread(task::LongCall &call, Works works)
    : call_(call), works_(std::move(works)), thread_([this] { work(); }) {}

CycleThread::~CycleThread() {
    give_back();
    {
        const std::lock_guard lock(mutex_);
        ending_ = true;
    }
    begun_.notify_one();
    thread_.join();
}

void CycleThread::give_back() {
    if (taken_) {
        taken_ = false;
        if (call_.give_back()) {
            set_lowered(false);
        }
    }
}

void CycleThread::run(std::int64_t now_ns) {
    give_back();
    std::unique_lock lock(mutex_);
    const auto hasEnded = [this] { return !running_; };
    if (hasEnded()) {
        late_ = false;
        set_lowered(false);
        now_ns_ = now_ns;
        running_ = true;
        begun_.notify_one();
    }
    auto patience = late_ ? std::chrono::nanoseconds(0) : std::chrono::nanoseconds(PATIENCE_NS);
    while (!ended_.wait_for(lock, patience, hasEnded)) {
        if (call_.take()) {
            taken_ = late_ = true;
            lock.unlock();
            set_lowered(true);
            works_.apart(now_ns);
            return;
        }
        set_lowered(false);  // the call has ended
        patience = LOOK_AGAIN;
    }
}

void CycleThread::set_lowered(bool lowered) {
    if (lowered != lowered_) {
        lowered_ = lowered;
        lowered ? reset_priority(thread_id_) : raise_priority(thread_id_);
    }
}

bool CycleThread::end_call(std::int64_t most_ns) {
    give_back();
    std::unique_lock lock(mutex_);
    const bool ended = ended_.wait_for(lock, std::chrono::nanoseconds(most_ns), [this] { return !running_; });
    taken_ = !ended && call_.take();
    return ended;
}

void CycleThread::work() {
    thread_id_ = ::gettid();
    std::unique_lock lock(mutex_);
    while (true) {
        begun_.wait(lock, [this] { return running_ || ending_; });
        if (ending_) {
            return;
        }
        const std::int64_t now_ns = now_ns_;
        lock.unlock();
        works_.whole(now_ns);
        lock.lock();
        running_ = false;
        ended_.notify_one();
    }
}

}  // namespace mw::machine

// SPDX-License-Identifier: GPL-2.0-or-later
#include "clients/screen/http/background_jobs.hh"

namespace mw::screen {

Worker::Worker(std::function<void(std::function<void()>)> post)
    : post_(std::move(post)), thread_([this] { work(); }) {}

void Worker::run(Job job, Reply reply) {
    {
        const std::lock_guard lock(mutex_);
        jobs_.emplace_back(std::move(job), std::move(reply));
    }
    more_.notify_one();
}

void Worker::end() {
    std::deque<std::pair<Job, Reply>> dropped;
    {
        const std::lock_guard lock(mutex_);
        isEnding_ = true;
        std::swap(dropped, jobs_);
    }
    more_.notify_one();
    if (thread_.joinable()) {
        thread_.join();
    }
}

void Worker::work() {
    while (true) {
        std::pair<Job, Reply> next;
        {
            std::unique_lock lock(mutex_);
            more_.wait(lock, [this] { return isEnding_ || !jobs_.empty(); });
            if (isEnding_) {
                return;
            }
            next = std::move(jobs_.front());
            jobs_.pop_front();
        }
        auto response = std::make_shared<Response>(next.first());
        post_([reply = std::move(next.second), response] { reply(std::move(*response)); });
    }
}

}  // namespace mw::screen

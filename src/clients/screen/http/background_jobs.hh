// SPDX-License-Identifier: GPL-2.0-or-later
// Runs long work outside of the server's thread, so that stops are not delayed.
#pragma once

#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>
#include <thread>
#include <utility>

#include "clients/screen/http/http_types.hh"

namespace mw::screen {

/// Runs blocking work in another thread.
class BackgroundJobs {
  public:
    using Job = std::function<Response()>;

    virtual ~BackgroundJobs() = default;
    /// Runs one job after the other; `reply` is called in the server's thread with the result of `job`.
    virtual void run(Job job, Reply reply) = 0;
};

/// A separate thread.
class Worker final : public BackgroundJobs {
  public:
    /// `post` calls a function in the server's thread; it must outlive the worker.
    explicit Worker(std::function<void(std::function<void()>)> post);
    ~Worker() override { end(); }
    Worker(const Worker &) = delete;
    Worker &operator=(const Worker &) = delete;

    void run(Job job, Reply reply) override;
    /// Ends the current job; waiting jobs are dropped.
    void end();

  private:
    void work();

    std::function<void(std::function<void()>)> post_;
    std::mutex mutex_;
    std::condition_variable more_;
    std::deque<std::pair<Job, Reply>> jobs_;
    bool isEnding_ = false;
    std::thread thread_;
};

}  // namespace mw::screen

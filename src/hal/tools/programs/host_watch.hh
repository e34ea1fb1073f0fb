// SPDX-License-Identifier: GPL-2.0-or-later
// Notices within 20 ms that the realtime process has ended, whatever the program itself waits for.
#pragma once

#include <functional>
#include <thread>

#include "hal/host/host_client.hh"

namespace mw::hal::tools {

class HostWatch {
  public:
    /// `on_death` is called once, in a thread of the watch. After that the thread that made the watch gets
    /// SIGTERM every 10 ms until the watch ends, so that no system call keeps it; who lets on_death return
    /// handles that signal. `host` must outlive the watch.
    HostWatch(const HostClient &host, std::function<void()> on_death);
    ~HostWatch();
    HostWatch(const HostWatch &) = delete;
    HostWatch &operator=(const HostWatch &) = delete;

  private:
    std::jthread thread_;
};

}  // namespace mw::hal::tools

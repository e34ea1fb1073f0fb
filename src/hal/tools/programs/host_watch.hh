// SPDX-License-Identifier: GPL-2.0-or-later
// Detects the end of the realtime process within 20 ms, independent of the program's own waits.
#pragma once

#include <functional>
#include <thread>

#include "hal/host/host_client.hh"

namespace mw::hal::tools {

class HostWatch {
  public:
    /// `on_death` is called once, in a separate thread. If it returns, the thread that created the watch
    /// receives SIGTERM every 10 ms until the watch ends, so that it does not remain in a system call; that
    /// thread must handle the signal. `host` must outlive the watch.
    HostWatch(const HostClient &host, std::function<void()> on_death);
    ~HostWatch();
    HostWatch(const HostWatch &) = delete;
    HostWatch &operator=(const HostWatch &) = delete;

  private:
    std::jthread thread_;
};

}  // namespace mw::hal::tools

// SPDX-License-Identifier: GPL-2.0-or-later
// The realtime process: owns the HAL instance and its threads, loads modules for clients, ends on request.
#pragma once

#include <memory>
#include <string>

#include "base/result.hh"
#include "runtime/realtime_scheduler.hh"

namespace mw::hal {

struct HostServerOptions {
    std::string instance;
    runtime::RealtimeOptions realtime;
    /// Receiver of modules' messages; standard error when null.
    runtime::Log::Sink sink = nullptr;
    void *sink_context = nullptr;
    /// pidfd of the process that controls this one from the start; -1: none
    int controller_fd = -1;
};

/// One per instance. The end of a process with components is detected at once (pidfd): its outputs take their
/// safe values, its components are removed, and the log names them. When the controlling process dies,
/// modules that requested it (mw_ext_watch_controller) are notified at once. When they report that the
/// machine has stopped, or after 10 s, the outputs of the dead process take their safe values, other
/// processes with components receive SIGTERM, and the server ends.
class HostServer {
  public:
    /// Creates the instance and listens; an error when a realtime process of that name is running. Blocks
    /// SIGTERM and SIGINT in this thread and those started from it, so that run() can end in an orderly way.
    static Result<std::unique_ptr<HostServer>> create(const HostServerOptions &options);
    /// Stops the threads and unloads everything.
    ~HostServer();
    HostServer(const HostServer &) = delete;
    HostServer &operator=(const HostServer &) = delete;

    /// Serves until a client, SIGTERM, SIGINT or the end of the controlling process ends it.
    void run();

  private:
    struct Impl;
    explicit HostServer(std::unique_ptr<Impl> impl);
    std::unique_ptr<Impl> impl_;
};

}  // namespace mw::hal

// SPDX-License-Identifier: GPL-2.0-or-later
// The realtime process: owns the HAL instance and its threads, loads modules for others, ends when told.
#pragma once

#include <memory>
#include <string>

#include "base/result.hh"
#include "runtime/realtime_scheduler.hh"

namespace mw::hal {

struct HostServerOptions {
    std::string instance;
    runtime::RealtimeOptions realtime;
    /// Where messages of modules go; standard error when null.
    runtime::Log::Sink sink = nullptr;
    void *sink_context = nullptr;
    /// A pidfd of the process that controls this one from the start on; -1: none yet.
    int controller_fd = -1;
};

/// One per instance. The end of a process that has components is noticed at once (pidfd): their outputs take
/// their safe values, they vanish, and the log names them. When the process that took control dies, modules
/// that asked for it (mw_ext_watch_controller) are told at once. When they say that the machine has stopped,
/// at the latest after 10 s, the outputs of the dead take their safe values, other processes with components
/// are asked to end (SIGTERM), and the server ends.
class HostServer {
  public:
    /// Takes the instance and listens; an error when a realtime process of that name is alive. Blocks SIGTERM
    /// and SIGINT in this thread and those started from it, so that run() can end cleanly.
    static Result<std::unique_ptr<HostServer>> create(const HostServerOptions &options);
    /// Stops the threads and unloads everything.
    ~HostServer();
    HostServer(const HostServer &) = delete;
    HostServer &operator=(const HostServer &) = delete;

    /// Serves until told to end, by a client, SIGTERM or SIGINT, or the end of the controlling process.
    void run();

  private:
    struct Impl;
    explicit HostServer(std::unique_ptr<Impl> impl);
    std::unique_ptr<Impl> impl_;
};

}  // namespace mw::hal

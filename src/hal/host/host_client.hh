// SPDX-License-Identifier: GPL-2.0-or-later
// The realtime process (millwright-rt) as seen by other processes. [one thread]
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/result.hh"
#include "hal/core/host.hh"

namespace mw::hal {

/// Destination of modules' messages: standard error of the starter, or, for a process that outlives its
/// starter, INSTANCE.log in the runtime folder.
enum class MessagesTo : std::uint8_t { STDERR, FILE };

/// Lifetime of a realtime process: until it is ended on request, or at most as long as the process that
/// starts it.
enum class Lifetime : std::uint8_t { OWN, STARTER };

class HostClient final : public Host {
  public:
    /// Joins the realtime process of `instance`; an error when none is running.
    static Result<std::unique_ptr<HostClient>> connect(const std::string &instance);
    /// Starts bin/millwright-rt for `instance` (an error when one is running) and joins it. With
    /// Lifetime::STARTER this process controls it from its first moment on, as by control().
    static Result<std::unique_ptr<HostClient>> start(const std::string &instance,
                                                     MessagesTo messages = MessagesTo::STDERR,
                                                     Lifetime lifetime = Lifetime::OWN);
    ~HostClient() override;

    Instance &hal() noexcept override;
    Result<> load_realtime(const std::string &name, const std::vector<std::string> &args) override;
    Result<> unload_realtime(const std::string &name) override;
    Result<bool> isModuleLoaded(const std::string &name) override;
    Result<std::vector<std::string>> modules() override;
    Result<> set_log_level(runtime::LogLevel level) override;

    /// From now on the realtime process brakes, stops everything and ends when this process ends (see
    /// HostServer).
    Result<> control();
    /// Requests the realtime process to stop everything and end, and waits until it has.
    Result<> shut_down();
    /// Error with the reason when the realtime process has ended; nothing while it runs. The kernel reports
    /// the end immediately. [any thread]
    std::optional<Error> death() const;
    /// Process id of the realtime process.
    int pid() const noexcept;

  private:
    struct Impl;
    explicit HostClient(std::unique_ptr<Impl> impl);
    Result<std::vector<std::string>> ask(const std::vector<std::string> &request);
    std::unique_ptr<Impl> impl_;
};

/// True when a realtime process of this instance is running.
bool isHostAlive(const std::string &instance);

/// Removes files that a dead realtime process of this instance has left; no effect while a process runs.
void remove_leftovers(const std::string &instance);

}  // namespace mw::hal

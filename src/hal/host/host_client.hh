// SPDX-License-Identifier: GPL-2.0-or-later
// The realtime process (millwright-rt) as other processes see it. [one thread]
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/result.hh"
#include "hal/core/host.hh"

namespace mw::hal {

/// Where the realtime process writes the messages of modules: to the standard error of who starts it, or, for
/// one that shall outlive its starter, to INSTANCE.log in the runtime folder.
enum class MessagesTo : std::uint8_t { STDERR, FILE };

/// How long a realtime process lives: until it is told to end, or at most as long as the process that starts
/// it.
enum class Lifetime : std::uint8_t { OWN, STARTER };

class HostClient final : public Host {
  public:
    /// Joins the realtime process of `instance`; an error when none is alive.
    static Result<std::unique_ptr<HostClient>> connect(const std::string &instance);
    /// Starts bin/millwright-rt for `instance` (an error when one is alive) and joins it. With
    /// Lifetime::STARTER it is controlled by this process from its first moment on, as by control().
    static Result<std::unique_ptr<HostClient>> start(const std::string &instance,
                                                     MessagesTo messages = MessagesTo::STDERR,
                                                     Lifetime lifetime = Lifetime::OWN);
    ~HostClient() override;

    Hal &hal() noexcept override;
    Result<> load_realtime(const std::string &name, const std::vector<std::string> &args) override;
    Result<> unload_realtime(const std::string &name) override;
    Result<bool> isModuleLoaded(const std::string &name) override;
    Result<std::vector<std::string>> modules() override;
    Result<> set_log_level(runtime::LogLevel level) override;

    /// From now on the realtime process brakes, stops all and ends when this process does (see HostServer).
    Result<> control();
    /// Tells the realtime process to stop all and end, and waits until it has.
    Result<> shut_down();
    /// That the realtime process has ended, and how; nothing while it is well. The kernel's word, so it is
    /// quick, and true at once. [any thread]
    std::optional<Error> death() const;
    /// Process id of the realtime process.
    int pid() const noexcept;

  private:
    struct Impl;
    explicit HostClient(std::unique_ptr<Impl> impl);
    Result<std::vector<std::string>> ask(const std::vector<std::string> &request);
    std::unique_ptr<Impl> impl_;
};

/// True when a realtime process of this instance is alive.
bool isHostAlive(const std::string &instance);

/// Removes what a realtime process of this instance left behind that has died; nothing while one is alive.
void remove_leftovers(const std::string &instance);

}  // namespace mw::hal

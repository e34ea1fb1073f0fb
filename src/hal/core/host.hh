// SPDX-License-Identifier: GPL-2.0-or-later
// The process that loads realtime modules for a HAL instance: this process under the virtual clock, or the
// realtime process.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.hh"
#include "hal/core/instance.hh"
#include "hal/core/loader.hh"

namespace mw::hal {

class Host {
  public:
    virtual ~Host() = default;

    /// The instance, as seen by this process.
    virtual Instance &hal() noexcept = 0;
    /// loadrt: `args` are "name=value" words.
    virtual Result<> load_realtime(const std::string &name, const std::vector<std::string> &args) = 0;
    /// unloadrt of one module.
    virtual Result<> unload_realtime(const std::string &name) = 0;
    virtual Result<bool> isModuleLoaded(const std::string &name) = 0;
    /// Loaded modules, newest last.
    virtual Result<std::vector<std::string>> modules() = 0;
    /// Maximum level of the host's log.
    virtual Result<> set_log_level(runtime::LogLevel level) = 0;
    std::int64_t now_ns() noexcept { return hal().now_ns(); }
};

/// Loads into this process: under the virtual clock, and in the realtime process.
class LocalHost final : public Host {
  public:
    /// A private (or, with options.shared, shared) instance under options.scheduler, which must outlive it.
    static Result<std::unique_ptr<LocalHost>>
    create(const InstanceOptions &options, std::vector<std::string> folders = Loader::default_folders());
    /// Stops the threads and unloads everything.
    ~LocalHost() override;

    Instance &hal() noexcept override { return *hal_; }
    Loader &loader() noexcept { return loader_; }
    Result<> load_realtime(const std::string &name, const std::vector<std::string> &args) override;
    Result<> unload_realtime(const std::string &name) override;
    Result<bool> isModuleLoaded(const std::string &name) override;
    Result<std::vector<std::string>> modules() override;
    Result<> set_log_level(runtime::LogLevel level) override;

  private:
    LocalHost(std::unique_ptr<Instance> hal, std::vector<std::string> folders);
    std::unique_ptr<Instance> hal_;
    Loader loader_;
};

}  // namespace mw::hal

// SPDX-License-Identifier: GPL-2.0-or-later
#include "hal/core/host.hh"

#include <utility>

namespace mw::hal {

LocalHost::LocalHost(std::unique_ptr<Instance> hal, std::vector<std::string> folders)
    : hal_(std::move(hal)), loader_(*hal_, std::move(folders)) {}

LocalHost::~LocalHost() {
    (void)hal_->set_lock(LOCK_NONE);
}

Result<std::unique_ptr<LocalHost>> LocalHost::create(const InstanceOptions &options,
                                                     std::vector<std::string> folders) {
    auto hal = Instance::create(options);
    if (!hal) {
        return std::unexpected(hal.error());
    }
    return std::unique_ptr<LocalHost>(new LocalHost(std::move(*hal), std::move(folders)));
}

Result<> LocalHost::load_realtime(const std::string &name, const std::vector<std::string> &args) {
    return loader_.load(name, args);
}

Result<> LocalHost::unload_realtime(const std::string &name) {
    return loader_.unload(name);
}

Result<bool> LocalHost::isModuleLoaded(const std::string &name) {
    return loader_.isLoaded(name);
}

Result<std::vector<std::string>> LocalHost::modules() {
    return loader_.modules();
}

Result<> LocalHost::set_log_level(runtime::LogLevel level) {
    hal_->log().set_level(level);
    return {};
}

}  // namespace mw::hal

// SPDX-License-Identifier: GPL-2.0-or-later
#include "clients/nml/remote/find_machine.hh"

#include <cstdlib>
#include <map>
#include <memory>
#include <mutex>
#include <string_view>

#include <fmt/format.h>

#include "clients/nml/bridge/bridge.hh"
#include "clients/nml/config/config_file.hh"
#include "clients/nml/remote/remote_machine.hh"

namespace mw::nml {
namespace {

/// The process name of screens and programs in P lines.
constexpr const char *CLIENT_PROCESS = "xemc";

Result<Config> read_config(const std::string &path) {
    std::string wrong;
    diagnostics::Sink sink([&wrong](const diagnostics::Diagnostic &found) {
        if (found.severity == diagnostics::Severity::ERROR) {
            wrong += (wrong.empty() ? "" : "\n") + found.str();
        }
    });
    auto config = load_config(path, sink);
    if (!config.has_value() && !wrong.empty()) {
        return fail(wrong);
    }
    return config;
}

/// Checks that the three channels belong to one machine.
Result<bool> is_remote(const Config &config, const std::string &path) {
    int count = 0, remote = 0;
    for (const char *const buffer : {COMMAND_CHANNEL, STATUS_CHANNEL, ERROR_CHANNEL}) {
        const ProcessSettings *const line = config.find_process(CLIENT_PROCESS, buffer);
        if (line == nullptr || config.find_buffer(buffer) == nullptr) {
            return fail(fmt::format("{}: no {} line for {}", path, line == nullptr ? 'P' : 'B',
                                    line == nullptr
                                        ? fmt::format("process '{}' and buffer '{}'", CLIENT_PROCESS, buffer)
                                        : fmt::format("buffer '{}'", buffer)));
        }
        ++count;
        remote += line->isRemote ? 1 : 0;
    }
    if (remote != 0 && remote != count) {
        return fail(fmt::format("{}: process '{}' has LOCAL and REMOTE channels", path, CLIENT_PROCESS), {},
                    "Commands and status must be of one machine: set LOCAL or REMOTE in all three P lines.");
    }
    return remote != 0;
}

/// The connections of this process, by file.
class Connected {
  public:
    Result<std::shared_ptr<RemoteMachine>> get(const std::string &path, Config config) {
        const std::lock_guard lock(mutex_);
        auto machine = machines_[path].lock();
        if (machine != nullptr && machine->check().has_value()) {
            return machine;
        }
        // Starts at the current number, so that serial numbers never decrease for a client.
        const mailbox::Serial serial = machine != nullptr ? machine->segment().serials.load() : 0;
        auto made = RemoteMachine::connect(std::move(config), CLIENT_PROCESS, serial);
        if (made.has_value()) {
            machines_[path] = *made;
        }
        return made;
    }

  private:
    std::mutex mutex_;
    std::map<std::string, std::weak_ptr<RemoteMachine>> machines_;
};

}  // namespace

std::string nml_file_of_environment() {
    const char *const file = std::getenv("NMLFILE");
    const char *const ini = std::getenv("INI_FILE_NAME");
    const bool is_ini = file != nullptr && ini != nullptr && std::string_view(file) == ini;
    return file == nullptr || is_ini ? "" : file;
}

Result<client::Viewer> find_machine(const std::string &instance, const std::string &nml_file) {
    if (nml_file.empty()) {
        return client::Viewer::attach(instance);
    }
    auto config = read_config(nml_file);
    if (!config.has_value()) {
        return std::unexpected(config.error());
    }
    const auto remote = is_remote(*config, nml_file);
    if (!remote.has_value()) {
        return std::unexpected(remote.error());
    }
    if (!*remote) {
        return client::Viewer::attach(instance);
    }
    static Connected connected;
    auto machine = connected.get(nml_file, std::move(*config));
    return machine.has_value() ? Result<client::Viewer>(client::Viewer(std::move(*machine)))
                               : std::unexpected(machine.error());
}

}  // namespace mw::nml

// SPDX-License-Identifier: GPL-2.0-or-later
#include "clients/screen/assembly/machine_screen.hh"

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <memory>
#include <utility>

#include "base/duration.hh"
#include "base/text.hh"
#include "clients/screen/assembly/ini_facts.hh"
#include "clients/screen/files/filter.hh"
#include "clients/screen/hal/dialog_facts.hh"
#include "clients/screen/hal/postgui.hh"
#include "hal/host/host_client.hh"

namespace mw::screen {
namespace {

/// Interval of checks for outcomes while a screen is open, and for the machine otherwise.
constexpr auto TICK = std::chrono::milliseconds(10), IDLE_TICK = std::chrono::milliseconds(100);

/// Connects to the running machine, if it uses this INI file.
Result<client::Client> connect(const std::string &instance, const std::string &ini,
                               client::Places places = client::Places::ORDINARY) {
    auto client = client::Client::connect(instance, client::Role::OPERATOR, places);
    if (!client.has_value()) {
        return client;
    }
    const mailbox::Identity identity = client->identity();
    if (identity.ini.empty()) {
        return fail("the machine starts");
    }
    if (!identity.isLasting) {
        return fail("'millwright run' runs a program on its own machine");
    }
    if (identity.ini.str() != ini) {
        return fail("the running machine was started from " + identity.ini.str() + ", not from " + ini);
    }
    return client;
}

std::int64_t now_ns() {
    return std::chrono::steady_clock::now().time_since_epoch() / std::chrono::nanoseconds(1);
}

std::string folder_of(const std::string &path) {
    return std::filesystem::path(path).parent_path().string();
}

/// Lets the routes read programs and run filters.
ApiSetup with_readers(ApiSetup setup, PathReaders &readers, const ini::IniFile &ini) {
    setup.read_path = [&readers](const std::string &path, const Requester &by) {
        return readers.read(path, by);
    };
    setup.read_times = [&readers](const std::string &path, const TimeOverrides &overrides,
                                  const Requester &by) { return readers.read_times(path, overrides, by); };
    setup.run_filter = [&readers, filters = filters_of(ini), folder = folder_of(setup.facts.ini)](
                           const std::string &path, const std::string &made, const Requester &by) {
        const std::string lower = to_lower(path);
        const auto filter =
            std::ranges::find_if(filters, [&](const auto &one) { return lower.ends_with(one.first); });
        if (filter == filters.end()) {
            return Result<std::shared_ptr<PieceQueue>>(fail("[FILTER] has no program for " + path));
        }
        return readers.run([command = filter->second, folder, path,
                            made](PieceQueue &pieces) { run_filter({command, folder, path, made}, pieces); },
                           by);
    };
    return setup;
}

}  // namespace

ApiSetup api_setup(const MachineScreenOptions &options, const machine::LoadedConfig &loaded,
                   diagnostics::Sink &sink) {
    const std::string ini = options.ini, instance = options.instance;
    ApiSetup setup;
    setup.facts = machine_facts(loaded, sink);
    setup.facts.ini = ini;
    setup.facts.instance = instance;
    setup.facts.filters.folder = filtered_folder(instance);
    setup.screens.connect = [instance, ini] { return connect(instance, ini); };
    setup.screens.connect_for_all = [instance, ini] {
        return connect(instance, ini, client::Places::RESERVED);
    };
    setup.screens.version = options.version;
    setup.screens.status_period_ns = to_ns(status_period_s(loaded.ini, sink));
    setup.screen_folder = options.screen_folder;
    setup.dialogs = dialog_facts(loaded.ini, sink);
    setup.connect_hal = [instance]() -> Result<std::unique_ptr<hal::Host>> {
        auto joined = hal::HostClient::connect(instance);
        return joined.has_value() ? Result<std::unique_ptr<hal::Host>>(std::move(*joined))
                                  : std::unexpected(joined.error());
    };
    const auto commands = postgui_commands(loaded.ini, options.programs);
    if (options.is_display && !commands.empty()) {
        setup.begin_hal = [commands, folder = folder_of(ini)] { return run_postgui(commands, folder); };
    }
    return setup;
}

std::vector<std::string> frames_of(const MachineFacts &facts) {
    std::vector<std::string> frames;
    for (const Tab &tab : facts.tabs) {
        if (tab.kind == Tab::Kind::FRAME) {
            frames.push_back(tab.content);
        }
    }
    return frames;
}

MachineScreen::MachineScreen(Server &server, const machine::LoadedConfig &loaded, ApiSetup setup)
    : server_(server), readers_(loaded, path_look(setup.facts)),
      disk_([&server](std::function<void()> act) { server.post(std::move(act)); }),
      hal_([&server](std::function<void()> act) { server.post(std::move(act)); }),
      api_(server, {disk_, hal_}, with_readers(std::move(setup), readers_, loaded.ini), now_ns) {}

MachineScreen::~MachineScreen() {
    readers_.cancel();
    disk_.end();
    hal_.end();
}

void MachineScreen::run() {
    server_.run_for(api_, api_.count_screens() > 0 ? TICK : IDLE_TICK);
    api_.tick();
}

}  // namespace mw::screen

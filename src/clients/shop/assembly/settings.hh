// SPDX-License-Identifier: GPL-2.0-or-later
// What the INI file of a shop sets.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/diagnostics/sink.hh"
#include "base/ini/ini_file.hh"
#include "clients/publish/sparkplug/mosquitto_link.hh"
#include "clients/shop/host/host_application.hh"
#include "clients/shop/notify/notifier.hh"
#include "clients/shop/store/store.hh"

namespace mw::shop {

struct PagePort {
    int port = 0;
    std::string address;  ///< empty: this computer only
    std::vector<std::string> names;
};

struct Settings {
    publish::LinkSettings link;
    HostSettings host;
    StoreSettings store;
    std::optional<PagePort> page;  ///< nothing: no page
    NotifierSettings notify;
};

/// Reports each problem with file, line and column; nothing when there are any.
std::optional<Settings> read_settings(const ini::IniFile &file, diagnostics::Sink &sink);

}  // namespace mw::shop

// SPDX-License-Identifier: GPL-2.0-or-later
// The settings in the INI file of a shop.
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
    std::string address;  ///< empty: only this computer
    std::vector<std::string> names;
    std::string secrets;  ///< folder; empty: other computers read the page without a token
};

struct Settings {
    publish::LinkSettings link;
    HostSettings host;
    StoreSettings store;
    std::optional<PagePort> page;  ///< nothing: no page
    NotifierSettings notify;
};

/// Reports each problem with file, line and column; returns nothing if there are problems.
std::optional<Settings> read_settings(const ini::IniFile &file, diagnostics::Sink &sink);

}  // namespace mw::shop

// SPDX-License-Identifier: GPL-2.0-or-later
// The settings in [PUBLISH] of a machine's INI file.
#pragma once

#include <optional>
#include <string>

#include "base/diagnostics/sink.hh"
#include "base/ini/ini_file.hh"
#include "clients/publish/mtconnect/agent.hh"
#include "clients/publish/offers/offer_session.hh"
#include "clients/publish/readings.hh"
#include "clients/publish/sparkplug/data_log.hh"
#include "clients/publish/sparkplug/edge_node.hh"
#include "clients/publish/sparkplug/mosquitto_link.hh"

namespace mw::publish {

struct AgentPort {
    int port = 0;
    std::string address;  ///< empty: only this computer
    std::vector<std::string> names;
};

struct Settings {
    std::optional<LinkSettings> link;  ///< nothing: no connection to a broker
    NodeSettings node;
    std::string store;
    LogLimits store_limits;
    double interval_s = 0.1;
    Deadbands deadbands;
    std::optional<OfferSettings> offers;  ///< nothing: no offers are received
    std::optional<AgentPort> agent_port;  ///< nothing: no agent
    mtconnect::AgentSettings agent;

    std::string offers_folder() const { return store + "/offers"; }
};

/// Data about this computer.
struct Surroundings {
    std::string host;          ///< name of the computer
    std::string machine_id;    ///< unique
    std::string state_folder;  ///< $XDG_STATE_HOME or ~/.local/state; empty: neither is set
};
Surroundings this_computer();

/// Reports each problem with file, line and column; returns nothing if there are problems.
std::optional<Settings> read_settings(const ini::IniFile &file, const Surroundings &around,
                                      diagnostics::Sink &sink);

}  // namespace mw::publish

// SPDX-License-Identifier: GPL-2.0-or-later
// What [PUBLISH] of a machine's INI file sets.
#pragma once

#include <optional>
#include <string>

#include "base/diagnostics/sink.hh"
#include "base/ini/ini_file.hh"
#include "clients/publish/mtconnect/agent.hh"
#include "clients/publish/readings.hh"
#include "clients/publish/sparkplug/data_log.hh"
#include "clients/publish/sparkplug/edge_node.hh"
#include "clients/publish/sparkplug/mosquitto_link.hh"

namespace mw::publish {

struct AgentPort {
    int port = 0;
    std::string address;  ///< empty: this computer only
    std::vector<std::string> names;
};

struct Settings {
    std::optional<LinkSettings> link;  ///< nothing: no broker
    NodeSettings node;
    std::string store;
    LogLimits store_limits;
    double interval_s = 0.1;
    Deadbands deadbands;
    std::optional<AgentPort> agent_port;  ///< nothing: no agent
    mtconnect::AgentSettings agent;
};

/// What depends on this computer.
struct Surroundings {
    std::string host;          ///< its name
    std::string machine_id;    ///< unique
    std::string state_folder;  ///< $XDG_STATE_HOME or ~/.local/state; empty: there is none
};
Surroundings this_computer();

/// Reports each problem with file, line and column; nothing when there are any.
std::optional<Settings> read_settings(const ini::IniFile &file, const Surroundings &around,
                                      diagnostics::Sink &sink);

}  // namespace mw::publish

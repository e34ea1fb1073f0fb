// SPDX-License-Identifier: GPL-2.0-or-later
// The keys of section [PUBLISH].
#pragma once

#include <array>

#include "base/ini/ini_key.hh"

namespace mw::publish {

// clang-format off
inline constexpr auto PUBLISH_KEYS = std::to_array<ini::IniKey>({
    ini::ini_list("PUBLISH", "BROKER", "HOST or HOST:PORT of an MQTT broker; several are tried one after another. Without it nothing is sent to a broker"),
    ini::ini_text("PUBLISH", "GROUP", "Sparkplug group", "millwright"),
    ini::ini_text("PUBLISH", "NODE", "Sparkplug edge node; without it the name of this computer"),
    ini::ini_text("PUBLISH", "DEVICE", "Sparkplug device and MTConnect device; without it [EMC]MACHINE"),
    ini::ini_text("PUBLISH", "PRIMARY_HOST", "Sparkplug host application: nothing is sent while it is offline"),
    ini::ini_flag("PUBLISH", "DATA_TYPES", false, "data messages have the types of their values, too: for receivers that need them, which Sparkplug advises against"),
    ini::ini_flag("PUBLISH", "TLS", false, "encrypts the connection to the broker and checks its certificate"),
    ini::ini_text("PUBLISH", "CA_FILE", "certificate authorities (PEM) of the broker; without it those of this computer"),
    ini::ini_text("PUBLISH", "CERTIFICATE", "client certificate (PEM) for the broker"),
    ini::ini_text("PUBLISH", "KEY", "private key (PEM) of that certificate"),
    ini::ini_text("PUBLISH", "USER", "user at the broker"),
    ini::ini_text("PUBLISH", "PASSWORD_FILE", "file with the password of USER, readable by this user only"),
    ini::ini_whole("PUBLISH", "KEEPALIVE", "s", 30, {5, 3600}, "interval of signs of life to the broker"),
    ini::ini_text("PUBLISH", "STORE", "folder of values that wait for the broker; without it $XDG_STATE_HOME/millwright/publish/DEVICE, or below ~/.local/state"),
    ini::ini_number("PUBLISH", "STORE_SIZE", "MB", 64, {1, 1e6}, "disk space of STORE; the oldest values are dropped when it is exceeded"),
    ini::ini_flag("PUBLISH", "OFFERS", false, "receives programs that PRIMARY_HOST offers; an operator accepts them at the screen"),
    ini::ini_number("PUBLISH", "INTERVAL", "s", 0.1, {0.01, 3600}, "period in which values are read"),
    ini::ini_list("PUBLISH", "DEADBAND", "NAME VALUE: smallest change of a metric that is published, in its unit; # in NAME as in the reference page"),
    ini::ini_whole("PUBLISH", "MTCONNECT_PORT", "", -1, {-1, 65535}, "TCP port of the MTConnect agent; 0: a free one; without it there is no agent"),
    ini::ini_text("PUBLISH", "MTCONNECT_LISTEN", "address at which other computers reach the agent, 0.0.0.0: all; without it only this computer"),
    ini::ini_list("PUBLISH", "MTCONNECT_NAME", "name by which other computers call this one, beside its own"),
    ini::ini_whole("PUBLISH", "MTCONNECT_BUFFER", "", 131072, {1024, 16777216}, "observations that the agent keeps"),
    ini::ini_text("PUBLISH", "UUID", "unique name of the MTConnect device; without it made from this computer and DEVICE"),
});
// clang-format on

}  // namespace mw::publish

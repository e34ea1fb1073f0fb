// SPDX-License-Identifier: GPL-2.0-or-later
// The keys of an INI section that set the connection to a broker.
#pragma once

#include "base/diagnostics/sink.hh"
#include "base/ini/ini_file.hh"
#include "base/ini/ini_key.hh"
#include "base/ini/ini_reader.hh"
#include "clients/publish/sparkplug/mosquitto_link.hh"

namespace mw::publish {

struct LinkKeys {
    const ini::IniKey &broker, &tls, &ca_file, &certificate, &key, &user, &password_file, &keepalive;
};

/// A file that is read, and where problems go.
struct SectionSource {
    const ini::IniFile &file;
    ini::IniReader &reader;
    diagnostics::Sink &sink;
};

/// Without names of the client. Problems go to the sink.
LinkSettings read_link_section(const SectionSource &source, const LinkKeys &keys);

/// The password in a file that other users cannot read; empty where the key is not set. Problems go to the
/// sink.
std::string read_password(const SectionSource &source, const ini::IniKey &key);

}  // namespace mw::publish

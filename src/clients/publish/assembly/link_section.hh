// SPDX-License-Identifier: GPL-2.0-or-later
// The keys of an INI section for the connection to a broker.
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

/// A file that is read, and the sink for its problems.
struct SectionSource {
    const ini::IniFile &file;
    ini::IniReader &reader;
    diagnostics::Sink &sink;
};

/// Does not read names of the client. Problems are reported to the sink.
LinkSettings read_link_section(const SectionSource &source, const LinkKeys &keys);

/// Reads the password from a file that other users cannot read; empty if the key is not set. Problems are
/// reported to the sink.
std::string read_password(const SectionSource &source, const ini::IniKey &key);

}  // namespace mw::publish

// SPDX-License-Identifier: GPL-2.0-or-later
// Access from other computers, as selected by the arguments of `millwright ui`.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/diagnostics/sink.hh"
#include "clients/screen/access/access.hh"
#include "clients/screen/access/secrets.hh"

namespace mw::screen {

/// The port for other computers.
struct RemoteDoor {
    std::string address;  ///< address of this computer; 0.0.0.0 or :: for all
    int port = 0;         ///< 0: any free port
    /// Names by which browsers may call it, in addition to its address.
    std::vector<std::string> names;
    Access access;  ///< with tokens if there is TLS
    std::optional<Certificate> tls;
};

struct DoorWords {
    std::string listen;              ///< ADDRESS or ADDRESS:PORT, IPv6 addresses in brackets; empty: none
    std::vector<std::string> names;  ///< additional names of this computer
    std::string unprotected;         ///< role of all connections, without TLS and token; empty: protected
};

/// Folder of the user: $XDG_CONFIG_HOME/millwright/screen, or ~/.config/millwright/screen.
Result<std::string> secrets_folder();

/// Nothing if not requested on the command line. Tokens and certificate are read from `folder`, and created
/// there if missing.
Result<std::optional<RemoteDoor>> remote_door(const DoorWords &words, const std::string &folder);

/// Tokens for other users of this computer, from `folder`; none, with a warning, if they cannot be read or
/// created.
Tokens local_tokens(const std::string &folder, diagnostics::Sink &sink);

/// Reports why connections from this computer have the role STATUS, including those of the server's user.
void report_unknown(const std::string &why, diagnostics::Sink &sink);

/// Text for a screen with the role STATUS: how to get other roles.
std::string status_note(int port, const std::string &folder);

/// Addresses to open on another computer, one line for each role, printed for the person who started the
/// server.
std::string door_text(const RemoteDoor &door, int port, const std::string &folder);

}  // namespace mw::screen

// SPDX-License-Identifier: GPL-2.0-or-later
// The way in from other computers that the words of `millwright ui` ask for.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/diagnostics/sink.hh"
#include "clients/screen/server.hh"

namespace mw::programs {

struct DoorWords {
    std::string listen;              ///< ADDRESS or ADDRESS:PORT, an IPv6 address in brackets; empty: none
    std::vector<std::string> names;  ///< of this computer, beside its own
    std::string unprotected;         ///< the role of whoever comes, without TLS and token; empty: protected
};

/// Of the user: $XDG_CONFIG_HOME/millwright/screen, or ~/.config/millwright/screen.
Result<std::string> secrets_folder();

/// Nothing where no word asks for one. Tokens and certificate are read from `folder`, and made there where
/// they are missing.
Result<std::optional<screen::RemoteDoor>> remote_door(const DoorWords &words, const std::string &folder);

/// For other users of this computer, from `folder`; none, with a warning, where they cannot be read or made.
screen::Tokens local_tokens(const std::string &folder, diagnostics::Sink &sink);

/// Why connections of this computer have the role STATUS, though they may be of the server's user.
void report_unknown(const std::string &why, diagnostics::Sink &sink);

/// What a screen of the role STATUS shows: how to get more.
std::string status_note(int port, const std::string &folder);

/// What to open on another computer, one line for each role: printed for whoever started the server.
std::string door_text(const screen::RemoteDoor &door, int port, const std::string &folder);

}  // namespace mw::programs

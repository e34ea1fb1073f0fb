// SPDX-License-Identifier: GPL-2.0-or-later
// Where a client finds its machine: on this computer, or where its NML file says.
#pragma once

#include <string>

#include "messages/client/client.hh"

namespace mw::nml {

/// Without a file: the machine of `instance` on this computer. With one: what the P lines of process `xemc`
/// say. LOCAL is the machine of `instance`; REMOTE is the server of the buffers. Viewers of one file share
/// one connection. A lost connection is replaced by the next call. An error: the file cannot be read or is
/// wrong, the machine is not there.
Result<client::Viewer> find_machine(const std::string &instance, const std::string &nml_file);

/// $NMLFILE where it names an NML file; empty elsewhere: the launcher sets it to the INI file of a machine
/// that has none.
std::string nml_file_of_environment();

}  // namespace mw::nml

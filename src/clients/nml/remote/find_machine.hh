// SPDX-License-Identifier: GPL-2.0-or-later
// Finds the machine of a client: on this computer, or as set in its NML file.
#pragma once

#include <string>

#include "messages/client/client.hh"

namespace mw::nml {

/// Without a file: the machine of `instance` on this computer. With a file: as in the P lines of process
/// `xemc`. LOCAL is the machine of `instance`, REMOTE the server of the buffers. Viewers with the same file
/// share a connection. The next call replaces a lost connection. An error: the file cannot be read or is
/// wrong, or there is no such machine.
Result<client::Viewer> find_machine(const std::string &instance, const std::string &nml_file);

/// $NMLFILE if it names an NML file, else empty. The launcher sets it to the INI file for a machine without
/// an NML file.
std::string nml_file_of_environment();

}  // namespace mw::nml

// SPDX-License-Identifier: GPL-2.0-or-later
// A buffer on a remote computer, or on this one through its server.
#pragma once

#include <memory>

#include "clients/nml/buffer/buffer.hh"
#include "clients/nml/config/settings.hh"
#include "clients/nml/net/socket.hh"

namespace mw::nml {

/// Connects by TCP=, else STCP=, else UDP= of the B line to its host, with the first name and password of its
/// password file. The next access renews a broken connection; a write that was under way is an error, because
/// it may or may not have been executed.
Result<std::unique_ptr<Buffer>> open_remote_buffer(const BufferSettings &buffer,
                                                   const ProcessSettings &process);

class LocalPlaces;
/// A local or remote buffer, as set in the line of the process.
Result<std::unique_ptr<Buffer>> open_any_buffer(const Config &config, const std::string &process,
                                                const std::string &buffer, const std::string &instance,
                                                LocalPlaces &local);

}  // namespace mw::nml

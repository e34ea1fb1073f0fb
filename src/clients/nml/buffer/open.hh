// SPDX-License-Identifier: GPL-2.0-or-later
// Makes connections to the buffers that a configuration names.
#pragma once

#include <memory>
#include <string>

#include "clients/nml/buffer/buffer.hh"
#include "clients/nml/buffer/place.hh"
#include "clients/nml/config/settings.hh"

namespace mw::nml {

/// Local buffers. `local` must outlive the connection. The connection has the rights of the process line.
/// Errors: GLOBMEM, what cannot be made or found, more processes than max_procs.
Result<std::unique_ptr<Buffer>> open_buffer(const BufferSettings &buffer, const ProcessSettings &process,
                                            const std::string &instance, LocalPlaces &local);

}  // namespace mw::nml

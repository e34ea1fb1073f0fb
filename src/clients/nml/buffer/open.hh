// SPDX-License-Identifier: GPL-2.0-or-later
// Creates connections to the buffers of a configuration.
#pragma once

#include <memory>
#include <string>

#include "clients/nml/buffer/buffer.hh"
#include "clients/nml/buffer/place.hh"
#include "clients/nml/config/settings.hh"

namespace mw::nml {

/// Local buffers. `local` must outlive the connection, which has the rights of the process line. Errors:
/// GLOBMEM, memory that cannot be created or found, more processes than max_procs.
Result<std::unique_ptr<Buffer>> open_buffer(const BufferSettings &buffer, const ProcessSettings &process,
                                            const std::string &instance, LocalPlaces &local);

}  // namespace mw::nml

// SPDX-License-Identifier: GPL-2.0-or-later
// Reads NML configuration files.
#pragma once

#include <string>
#include <string_view>

#include "base/diagnostics/sink.hh"
#include "base/result.hh"
#include "clients/nml/config/settings.hh"

namespace mw::nml {

/// Reports each wrong line as an error with file, line, column and field, and omits it. Warnings: unknown
/// options, lines about buffers that do not exist, settings with a different effect on this system.
Config parse_config(std::string_view text, const std::string &file, diagnostics::Sink &sink);

/// Files named in its lines are searched in its folder. An error when the file cannot be read or a line is
/// wrong; the sink receives each problem.
Result<Config> load_config(const std::string &path, diagnostics::Sink &sink);

}  // namespace mw::nml

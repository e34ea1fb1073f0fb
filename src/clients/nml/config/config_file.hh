// SPDX-License-Identifier: GPL-2.0-or-later
// Reads NML configuration files.
#pragma once

#include <string>
#include <string_view>

#include "base/diagnostics/sink.hh"
#include "base/result.hh"
#include "clients/nml/config/settings.hh"

namespace mw::nml {

/// Every line that says something wrong is an error with file, line, column and the name of the field, and is
/// left out. Warnings: unknown options, lines about buffers that there are none of, what this system does
/// otherwise.
Config parse_config(std::string_view text, const std::string &file, diagnostics::Sink &sink);

/// Files that its lines name are looked for in its folder. An error when the file cannot be read or a line of
/// it is wrong; the sink has been told each.
Result<Config> load_config(const std::string &path, diagnostics::Sink &sink);

}  // namespace mw::nml

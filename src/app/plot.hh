// SPDX-License-Identifier: GPL-2.0-or-later
// A picture of the tool path, seen from above and from an angle, as PNG or SVG.
#pragma once

#include <string>
#include <vector>

#include "base/result.hh"
#include "machine/path_monitor.hh"

namespace mw::machine {

/// Writes `path` (.png or .svg by its ending). `unit` labels the scale.
Result<> plot_path(const std::vector<PathPoint> &points, const std::string &title, const std::string &unit,
                   const std::string &path);

}  // namespace mw::machine

// SPDX-License-Identifier: GPL-2.0-or-later
// A picture of the tool path with axes and figures, as PNG or SVG.
#pragma once

#include <string>
#include <vector>

#include "base/result.hh"
#include "gcode/analysis/path_points.hh"
#include "machine/config/machine_config.hh"

namespace mw::programs {

/// Writes `path` (.png or .svg by its extension). A mill is drawn from above, with holes marked, and in
/// perspective; a lathe (no Y, or [DISPLAY]LATHE) with Z to the right and X upwards, with the centre line.
/// Machine coordinates.
Result<> plot_path(const std::vector<gcode::PathPoint> &points, const machine::MachineConfig &machine,
                   const std::string &program, const std::string &path);

/// Checks for errors of plot_path() in advance.
Result<> check_picture(const std::string &path);

}  // namespace mw::programs

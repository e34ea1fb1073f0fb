// SPDX-License-Identifier: GPL-2.0-or-later
// A picture of the tool path with axes and figures, as PNG or SVG.
#pragma once

#include <string>
#include <vector>

#include "base/result.hh"
#include "machine/analysis/path_points.hh"
#include "machine/config/machine_config.hh"

namespace mw::programs {

/// Writes `path` (.png or .svg by its ending). A mill is seen from above, with holes marked, and from an
/// angle; a lathe (no Y, or [DISPLAY]LATHE) with Z to the right and X upwards, the centre line drawn. Machine
/// coordinates.
Result<> plot_path(const std::vector<machine::PathPoint> &points, const machine::MachineConfig &machine,
                   const std::string &program, const std::string &path);

/// What plot_path() would refuse, before the work is done.
Result<> check_picture(const std::string &path);

}  // namespace mw::programs

// SPDX-License-Identifier: GPL-2.0-or-later
// One tool of the tool table.
#pragma once

#include <string>

#include "base/geometry/pose.hh"

namespace mw::tools {

struct ToolEntry {
    int toolno = -1;  ///< -1: no tool in this entry
    int pocketno = 0;
    geometry::Pose offset;                 ///< [machine units, degrees]
    double diameter = 0;                   ///< [machine units]
    double frontangle = 0, backangle = 0;  ///< lathe tools [degrees]
    int orientation = 0;                   ///< lathe tools, 0..9
    std::string comment;
};

}  // namespace mw::tools

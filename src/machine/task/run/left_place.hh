// SPDX-License-Identifier: GPL-2.0-or-later
// The state when a program was paused: an operator may stop the spindle, jog and change the tool before it
// continues.
#pragma once

#include <cstdint>

#include "base/geometry/pose.hh"
#include "machine/task/sequencer/program_spindles.hh"

namespace mw::task {

struct LeftPlace {
    geometry::Pose position;  ///< of the machine, when the axes were released
    int line = 0;
    int tool = 0;             ///< tool in the spindle
    std::uint64_t tools = 0;  ///< checksum of the tool table
    std::uint64_t tools_version = 0;
    ProgramSpindles spindles;
    bool isMistOn = false, isFloodOn = false;
};

}  // namespace mw::task

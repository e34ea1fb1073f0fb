// SPDX-License-Identifier: GPL-2.0-or-later
// Files of screw errors ([JOINT_n]COMP_FILE), read and checked before motion hears of them. Not realtime.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "base/result.hh"
#include "motion/interface/command.hh"

namespace mw::motion {

/// What the second and third number of a line are, on the way up and on the way down.
enum class ScrewFileType : std::uint8_t {
    ACTUAL = 0,  ///< where the joint really is when it is sent to the first number
    OFFSET = 1,  ///< what is to be added
};

/// The points of a file, in their order. Lines of three numbers; empty ones and those behind # do not count.
/// The error has line and column. `path` is only named.
Result<std::vector<LoadCompensation>> parse_screw_file(std::string_view text, const std::string &path,
                                                       int joint, ScrewFileType type);
Result<std::vector<LoadCompensation>> read_screw_file(const std::string &path, int joint, ScrewFileType type);

}  // namespace mw::motion

// SPDX-License-Identifier: GPL-2.0-or-later
// Reads and checks screw compensation files ([JOINT_n]COMP_FILE) before motion gets them. Not realtime.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "base/result.hh"
#include "motion/interface/command.hh"

namespace mw::motion {

/// Meaning of the second and third numbers of a line, for forward and reverse travel.
enum class ScrewFileType : std::uint8_t {
    ACTUAL = 0,  ///< measured position of the joint at the nominal position
    OFFSET = 1,  ///< correction to add
};

/// The points of a file, in order. Lines of three numbers; empty lines and text after # are ignored. Errors
/// have line and column. `path` is used in messages only.
Result<std::vector<LoadCompensation>> parse_screw_file(std::string_view text, const std::string &path,
                                                       int joint, ScrewFileType type);
Result<std::vector<LoadCompensation>> read_screw_file(const std::string &path, int joint, ScrewFileType type);

}  // namespace mw::motion

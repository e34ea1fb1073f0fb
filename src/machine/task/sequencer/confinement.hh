// SPDX-License-Identifier: GPL-2.0-or-later
// Which files of this computer the authority to operate reaches (docs/integrator/security.md).
#pragma once

#include <string>
#include <vector>

#include "base/result.hh"

namespace mw::task {

struct Confinement {
    /// [DISPLAY]PROGRAM_PREFIX and the folder of programs that filters have made; logs are written into the
    /// first.
    std::vector<std::string> program_folders;
    std::vector<std::string> program_extensions;  ///< in lower case, with the dot; [FILTER] included
    std::vector<std::string> kept_files;          ///< INI, HAL, tool table, ...: no program writes them
};

/// An error where `path`, with its links resolved, is not below one of the program folders, or has a name
/// that begins with a dot there. Nothing of the file is read.
Result<> check_program(const Confinement &confinement, const std::string &path);

/// Opens the file of (logopen,...), (logappend,...) or (probeopen ...) for writing; the caller closes the
/// descriptor. A relative path begins in the first program folder. Only regular files below that folder, with
/// an extension of a log, neither links nor files of the machine; no link is followed on the way.
Result<int> open_log(const Confinement &confinement, const std::string &path, bool isAppending);

}  // namespace mw::task

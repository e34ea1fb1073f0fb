// SPDX-License-Identifier: GPL-2.0-or-later
// The files of this computer that the authority to operate may access (docs/integrator/security.md).
#pragma once

#include <string>
#include <vector>

#include "base/result.hh"

namespace mw::task {

struct Confinement {
    /// [DISPLAY]PROGRAM_PREFIX, and the folder of programs converted by filters; logs are written to the
    /// first one.
    std::vector<std::string> program_folders;
    std::vector<std::string> program_extensions;  ///< in lower case, with the dot; [FILTER] included
    std::vector<std::string> kept_files;          ///< INI, HAL, tool table, ...: programs may not write them
};

/// An error if `path`, with links resolved, is not below a program folder or has a hidden component below it.
/// Does not read the file.
Result<> check_program(const Confinement &confinement, const std::string &path);

/// Opens the file of (logopen,...), (logappend,...) or (probeopen ...) for writing; the caller closes the
/// descriptor. A relative path starts in the first program folder. Only regular files below that folder with
/// a log extension; no links, no files of the machine.
Result<int> open_log(const Confinement &confinement, const std::string &path, bool appending);

}  // namespace mw::task

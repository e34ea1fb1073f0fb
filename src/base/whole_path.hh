// SPDX-License-Identifier: GPL-2.0-or-later
// Names of files as all programs and clients of a machine write them.
#pragma once

#include <string>

namespace mw {

/// Absolute, without links in the names of folders. A file that is a link itself keeps its own name and
/// folder: what an INI file names is looked for beside the link. A path that does not exist stays as it is.
std::string whole_path(const std::string &path);

}  // namespace mw

// SPDX-License-Identifier: GPL-2.0-or-later
// File names in the form that all programs and clients of a machine use.
#pragma once

#include <string>

namespace mw {

/// The absolute path with links in folder names resolved. A file that is itself a link keeps its name and
/// folder: files named in an INI file are searched beside the link. A path that does not exist is not
/// changed.
std::string whole_path(const std::string &path);

}  // namespace mw

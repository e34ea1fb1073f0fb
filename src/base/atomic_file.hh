// SPDX-License-Identifier: GPL-2.0-or-later
// Files that are either the old ones or the new ones, whatever happens in between.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "base/result.hh"

namespace mw {

/// Replaces `path` by `content`: writes a temporary file beside it, syncs it, renames it over, syncs the
/// folder. Permissions of an existing file are kept. On any error the old file is untouched and the temporary
/// is removed. That of a process that was killed is removed by the next write of the same file
/// (base/temporary_file.hh).
Result<> write_file_atomically(const std::string &path, std::string_view content);

/// As write_file_atomically(); what `path` had is in `path` + ".bak" before. The same content again leaves a
/// backup that is there as it is. Where the backup cannot be made, the file is written all the same, and the
/// error returned.
Result<> write_file_with_backup(const std::string &path, std::string_view content);

/// The name of the backup of a file.
std::string backup_of(const std::string &path);

/// A regular file for reading, or for `flags` of open(2); the caller closes the descriptor. A pipe, a device
/// or a folder is an error at once: reading or writing those may never end.
Result<int> open_regular_file(const std::string &path, int flags = 0);

/// The whole regular file as text; the error names the file and the system's reason. A file of more than
/// `most_bytes` is an error.
inline constexpr std::size_t MOST_FILE_BYTES = std::size_t{512} << 20;
Result<std::string> read_file(const std::string &path, std::size_t most_bytes = MOST_FILE_BYTES);

}  // namespace mw

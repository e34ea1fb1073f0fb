// SPDX-License-Identifier: GPL-2.0-or-later
// Atomic replacement of files: after a crash a file has either its old or its new content.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "base/result.hh"

namespace mw {

/// Replaces `path` by `content`: writes a temporary file beside it, syncs it, renames it to `path`, and syncs
/// the folder. Permissions of an existing file are kept. On any error the old file is unchanged and the
/// temporary file is removed. The next write of the same file removes the temporary file of a killed process
/// (base/temporary_file.hh).
Result<> write_file_atomically(const std::string &path, std::string_view content);

/// As write_file_atomically(); copies the old content of `path` to `path` + ".bak" first. If the content does
/// not change, an existing backup is kept. If the backup cannot be made, the file is still written, and the
/// error is returned.
Result<> write_file_with_backup(const std::string &path, std::string_view content);

/// Name of the backup of a file.
std::string backup_of(const std::string &path);

/// Opens a regular file for reading, or with `flags` of open(2); the caller closes the descriptor. A pipe, a
/// device or a folder is an error: reading or writing those may never end.
Result<int> open_regular_file(const std::string &path, int flags = 0);

/// Content of a regular file. The error names the file and the system's reason. A file of more than
/// `most_bytes` is an error.
inline constexpr std::size_t MOST_FILE_BYTES = std::size_t{512} << 20;
Result<std::string> read_file(const std::string &path, std::size_t most_bytes = MOST_FILE_BYTES);

}  // namespace mw

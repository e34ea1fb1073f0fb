// SPDX-License-Identifier: GPL-2.0-or-later
// A file that replaces another one when it is complete.
#pragma once

#include <optional>
#include <string>
#include <utility>

namespace mw {

/// A file with a hidden name in the folder of the target, locked (flock) until its process ends. It stays in
/// the same folder if that is renamed. The destructor removes a file that has not replaced the target. Errors
/// are in errno.
class TemporaryFile {
  public:
    /// First removes files that killed processes have left for the same target: files with such a name that
    /// no process has locked. On a file system without locks nothing is removed.
    static std::optional<TemporaryFile> create(const std::string &target);
    TemporaryFile(TemporaryFile &&other) noexcept;
    TemporaryFile &operator=(TemporaryFile &&) = delete;
    ~TemporaryFile();

    int fd() const { return fd_; }
    /// Syncs the file and renames it to the target.
    bool replace_target();
    bool sync_folder() const;

  private:
    TemporaryFile(int folder, std::string target) : folder_(folder), target_(std::move(target)) {}
    bool make(const std::string &prefix);

    int folder_ = -1, fd_ = -1;
    std::string target_, name_;  ///< in the folder; empty name: it has been renamed
};

/// Removes the temporary files of killed processes in the folder, for all targets. Links are not removed.
void remove_dead_temporary_files(const std::string &folder);

}  // namespace mw

// SPDX-License-Identifier: GPL-2.0-or-later
// A file that gets the name of another one when it is complete.
#pragma once

#include <optional>
#include <string>
#include <utility>

namespace mw {

/// Has a hidden name in the folder of the target, and a lock (flock) until its process ends. Uses the same
/// folder also after that is renamed. The destructor removes a file that has not replaced the target. Errors
/// are in errno.
class TemporaryFile {
  public:
    /// Removes what killed processes have left for the same target first: files with such a name that nobody
    /// has locked. Where the file system has no locks, nothing is removed.
    static std::optional<TemporaryFile> create(const std::string &target);
    TemporaryFile(TemporaryFile &&other) noexcept;
    TemporaryFile &operator=(TemporaryFile &&) = delete;
    ~TemporaryFile();

    int fd() const { return fd_; }
    /// Syncs it and gives it the name of the target.
    bool replace_target();
    bool sync_folder() const;

  private:
    TemporaryFile(int folder, std::string target) : folder_(folder), target_(std::move(target)) {}
    bool make(const std::string &prefix);

    int folder_ = -1, fd_ = -1;
    std::string target_, name_;  ///< in the folder; no name: it is renamed
};

/// Removes the temporary files of killed processes in the folder, those of any target. Links stay.
void remove_dead_temporary_files(const std::string &folder);

}  // namespace mw

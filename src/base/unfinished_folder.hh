// SPDX-License-Identifier: GPL-2.0-or-later
// A folder that gets its name when its content is complete.
#pragma once

#include <optional>
#include <string>
#include <utility>

namespace mw {

/// A folder with a hidden name beside the target, locked (flock) until its process ends. The destructor
/// removes a folder that has not become the target. Errors are in errno.
class UnfinishedFolder {
  public:
    /// Creates the folder. First removes folders that killed processes have left for the same target: those
    /// that no process has locked. The parent folder of the target must exist.
    static std::optional<UnfinishedFolder> create(const std::string &target);
    UnfinishedFolder(UnfinishedFolder &&other) noexcept;
    UnfinishedFolder &operator=(UnfinishedFolder &&) = delete;
    ~UnfinishedFolder();

    const std::string &path() const { return path_; }
    /// Renames it to the target, which must not exist or must be an empty folder.
    bool become_target();

  private:
    UnfinishedFolder(int fd, std::string path, std::string target)
        : fd_(fd), path_(std::move(path)), target_(std::move(target)) {}

    int fd_ = -1;
    std::string path_, target_;  ///< empty path: it has become the target
};

}  // namespace mw

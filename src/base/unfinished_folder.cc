// SPDX-License-Identifier: GPL-2.0-or-later
#include "base/unfinished_folder.hh"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <filesystem>

namespace mw {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t RANDOM_LETTERS = 6;  // of mkdtemp()

/// Locks the folder until the process ends; -1: another process has the lock, or there is no such folder.
int lock_of(const std::string &path) {
    const int fd = ::open(path.c_str(), O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC);
    if (fd >= 0 && ::flock(fd, LOCK_EX | LOCK_NB) != 0) {
        ::close(fd);
        return -1;
    }
    return fd;
}

/// True if the path still refers to the open folder.
bool isSame(const std::string &path, int fd) {
    struct stat named{}, opened{};
    return ::lstat(path.c_str(), &named) == 0 && ::fstat(fd, &opened) == 0 && named.st_ino == opened.st_ino &&
           named.st_dev == opened.st_dev;
}

void remove_dead(const fs::path &parent, const std::string &prefix) {
    std::error_code error;
    for (auto entry = fs::directory_iterator(parent, error); !error && entry != fs::directory_iterator();
         entry.increment(error)) {
        const std::string name = entry->path().filename().string();
        if (!name.starts_with(prefix) || name.size() != prefix.size() + RANDOM_LETTERS) {
            continue;
        }
        const int fd = lock_of(entry->path().string());
        if (fd >= 0) {
            std::error_code ignored;  // a file that cannot be removed does not prevent the new folder
            fs::remove_all(entry->path(), ignored);
            ::close(fd);
        }
    }
}

}  // namespace

std::optional<UnfinishedFolder> UnfinishedFolder::create(const std::string &target) {
    const fs::path to(target);
    const fs::path parent = to.has_parent_path() ? to.parent_path() : fs::path(".");
    const std::string prefix = "." + to.filename().string() + ".millwright-";
    remove_dead(parent, prefix);
    constexpr int TRIES = 10;
    for (int i = 0; i < TRIES; ++i) {
        std::string path = (parent / (prefix + std::string(RANDOM_LETTERS, 'X'))).string();
        if (::mkdtemp(path.data()) == nullptr) {
            return std::nullopt;
        }
        const int fd = lock_of(path);
        // Another process may have removed it before it was locked.
        if (fd >= 0 && isSame(path, fd)) {
            return UnfinishedFolder(fd, std::move(path), target);
        }
        if (fd >= 0) {
            ::close(fd);
        }
    }
    errno = EBUSY;
    return std::nullopt;
}

UnfinishedFolder::UnfinishedFolder(UnfinishedFolder &&other) noexcept
    : fd_(std::exchange(other.fd_, -1)), path_(std::exchange(other.path_, {})),
      target_(std::move(other.target_)) {}

UnfinishedFolder::~UnfinishedFolder() {
    const int error = errno;
    if (!path_.empty()) {
        std::error_code ignored;
        fs::remove_all(path_, ignored);
    }
    if (fd_ >= 0) {
        ::close(fd_);
    }
    errno = error;
}

bool UnfinishedFolder::become_target() {
    if (::rename(path_.c_str(), target_.c_str()) != 0) {
        return false;
    }
    path_.clear();
    return true;
}

}  // namespace mw

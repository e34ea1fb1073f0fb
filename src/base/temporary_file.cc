// SPDX-License-Identifier: GPL-2.0-or-later
#include "base/temporary_file.hh"

#include <dirent.h>
#include <fcntl.h>
#include <sys/file.h>
#include <sys/random.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <string_view>
#include <utility>
#include <vector>

namespace mw {
namespace {

constexpr std::string_view MARK = ".millwright-";
constexpr std::string_view LETTERS = "0123456789abcdefghijklmnopqrstuv";  // 32 letters: all equally probable
constexpr std::size_t NUM_LETTERS = 10;
/// The name of the target may be as long as the file system allows.
constexpr std::size_t MOST_OF_TARGET = 200;

std::string folder_of(const std::string &path) {
    const auto slash = path.rfind('/');
    if (slash == std::string::npos) {
        return ".";
    }
    return slash == 0 ? "/" : path.substr(0, slash);
}

std::string prefix_of(const std::string &target) {
    return "." + target.substr(0, MOST_OF_TARGET) + std::string(MARK);
}

/// An empty prefix matches the files of all targets.
bool isTemporary(std::string_view name, std::string_view prefix) {
    if (name.size() <= MARK.size() + NUM_LETTERS) {
        return false;
    }
    const std::string_view before = name.substr(0, name.size() - NUM_LETTERS);
    return (prefix.empty() ? name[0] == '.' && before.ends_with(MARK) : before == prefix) &&
           name.find_first_not_of(LETTERS, before.size()) == std::string_view::npos;
}

/// True if the name in the folder refers to the open file.
bool isSame(int folder, const char *name, int fd) {
    struct stat named{}, opened{};
    return ::fstatat(folder, name, &named, AT_SYMLINK_NOFOLLOW) == 0 && ::fstat(fd, &opened) == 0 &&
           S_ISREG(named.st_mode) && named.st_ino == opened.st_ino && named.st_dev == opened.st_dev;
}

bool hasOtherNames(int fd) {
    struct stat facts{};
    return ::fstat(fd, &facts) != 0 || facts.st_nlink > 1;
}

void remove_if_dead(int folder, const char *name) {
    const int fd = ::openat(folder, name, O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_NOCTTY | O_CLOEXEC);
    if (fd < 0) {
        return;
    }
    if (::flock(fd, LOCK_EX | LOCK_NB) == 0 && isSame(folder, name, fd) && !hasOtherNames(fd)) {
        ::unlinkat(folder, name, 0);
    }
    ::close(fd);
}

void remove_dead(int folder, const std::string &prefix) {
    const int own = ::openat(folder, ".", O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    DIR *const entries = own < 0 ? nullptr : ::fdopendir(own);
    if (entries == nullptr) {
        if (own >= 0) {
            ::close(own);
        }
        return;
    }
    std::vector<std::string> found;
    while (const dirent *const entry = ::readdir(entries)) {
        if (isTemporary(entry->d_name, prefix)) {
            found.emplace_back(entry->d_name);
        }
    }
    ::closedir(entries);
    for (const std::string &name : found) {
        remove_if_dead(folder, name.c_str());
    }
}

bool random_letters(std::string &text) {
    std::array<unsigned char, NUM_LETTERS> bytes{};
    if (::getrandom(bytes.data(), bytes.size(), 0) != static_cast<ssize_t>(bytes.size())) {
        return false;
    }
    for (const unsigned char byte : bytes) {
        text += LETTERS[byte % LETTERS.size()];
    }
    return true;
}

}  // namespace

std::optional<TemporaryFile> TemporaryFile::create(const std::string &target) {
    const int folder = ::open(folder_of(target).c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (folder < 0) {
        return std::nullopt;
    }
    TemporaryFile made(folder, target.substr(target.rfind('/') + 1));
    const std::string prefix = prefix_of(made.target_);
    remove_dead(folder, prefix);
    if (!made.make(prefix)) {
        return std::nullopt;
    }
    return made;
}

bool TemporaryFile::make(const std::string &prefix) {
    constexpr int TRIES = 10;
    for (int i = 0; i < TRIES; ++i) {
        std::string name = prefix;
        if (!random_letters(name)) {
            return false;
        }
        fd_ = ::openat(folder_, name.c_str(), O_RDWR | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0600);
        if (fd_ < 0 && errno != EEXIST) {
            return false;
        }
        if (fd_ < 0) {
            continue;
        }
        // Another process may have treated the file as abandoned before it was locked. This cannot happen on
        // a file system without locks.
        const bool taken = ::flock(fd_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK;
        if (!taken && isSame(folder_, name.c_str(), fd_)) {
            name_ = std::move(name);
            return true;
        }
        ::unlinkat(folder_, name.c_str(), 0);
        ::close(std::exchange(fd_, -1));
    }
    errno = EBUSY;
    return false;
}

TemporaryFile::TemporaryFile(TemporaryFile &&other) noexcept
    : folder_(std::exchange(other.folder_, -1)), fd_(std::exchange(other.fd_, -1)),
      target_(std::move(other.target_)), name_(std::exchange(other.name_, {})) {}

TemporaryFile::~TemporaryFile() {
    const int error = errno;
    if (!name_.empty()) {
        ::unlinkat(folder_, name_.c_str(), 0);
    }
    for (const int fd : {fd_, folder_}) {
        if (fd >= 0) {
            ::close(fd);
        }
    }
    errno = error;
}

bool TemporaryFile::replace_target() {
    if (::fsync(fd_) != 0 || ::renameat(folder_, name_.c_str(), folder_, target_.c_str()) != 0) {
        return false;
    }
    name_.clear();
    return true;
}

bool TemporaryFile::sync_folder() const {
    return ::fsync(folder_) == 0;
}

void remove_dead_temporary_files(const std::string &folder) {
    const int fd = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (fd >= 0) {
        remove_dead(fd, {});
        ::close(fd);
    }
}

}  // namespace mw

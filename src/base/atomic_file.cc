// SPDX-License-Identifier: GPL-2.0-or-later
#include "base/atomic_file.hh"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>

#include "base/temporary_file.hh"

namespace mw {
namespace {

class FileHandle {
  public:
    explicit FileHandle(int fd) : fd_(fd) {}
    FileHandle(const FileHandle &) = delete;
    FileHandle &operator=(const FileHandle &) = delete;
    ~FileHandle() {
        if (fd_ >= 0) {
            ::close(fd_);
        }
    }
    int get() const { return fd_; }

  private:
    int fd_;
};

std::unexpected<Error> system_failure(const std::string &doing, const std::string &path) {
    return fail("cannot " + doing + " '" + path + "': " + std::strerror(errno), {path, 0, 0});
}

std::unexpected<Error> not_regular(const std::string &path, mode_t mode) {
    const char *const kind = S_ISDIR(mode)    ? "a folder"
                             : S_ISFIFO(mode) ? "a pipe"
                             : S_ISSOCK(mode) ? "a socket"
                                              : "a device";
    return fail("'" + path + "' is " + kind + ", not a file", {path, 0, 0});
}

/// An error if `path` exists and is not a regular file.
Result<> check_regular(const std::string &path) {
    struct stat status{};
    if (::stat(path.c_str(), &status) == 0 && !S_ISREG(status.st_mode)) {
        return not_regular(path, status.st_mode);
    }
    return {};
}

bool write_all(int fd, std::string_view content) {
    while (!content.empty()) {
        const ssize_t n = ::write(fd, content.data(), content.size());
        if (n < 0 && errno == EINTR) {
            continue;
        }
        if (n <= 0) {
            return false;
        }
        content.remove_prefix(static_cast<std::size_t>(n));
    }
    return true;
}

/// A symbolic link is kept: the file that it points to is replaced.
std::string resolve(const std::string &path) {
    char *real = ::realpath(path.c_str(), nullptr);
    std::string out = real != nullptr ? real : path;
    std::free(real);
    return out;
}

}  // namespace

Result<> write_file_atomically(const std::string &path, std::string_view content) {
    const std::string target = resolve(path);
    if (auto regular = check_regular(target); !regular.has_value()) {
        return regular;
    }
    struct stat old{};
    const bool replacing = ::stat(target.c_str(), &old) == 0;
    const mode_t mode = replacing ? (old.st_mode & 07777) : 0644;
    auto file = TemporaryFile::create(target);
    if (!file.has_value()) {
        return system_failure("write", path);
    }
    if (::fchmod(file->fd(), mode) != 0 || !write_all(file->fd(), content) || !file->replace_target()) {
        return system_failure("write", path);
    }
    if (!file->sync_folder()) {
        return system_failure("sync the folder of", path);
    }
    return {};
}

std::string backup_of(const std::string &path) {
    return path + ".bak";
}

Result<> write_file_with_backup(const std::string &path, std::string_view content) {
    Result<> kept;
    if (::access(path.c_str(), F_OK) == 0) {
        const Result<std::string> old = read_file(path);
        const std::string backup = backup_of(path);
        if (!old.has_value()) {
            kept = std::unexpected(old.error());
        } else if (*old != content || ::access(backup.c_str(), F_OK) != 0) {
            kept = write_file_atomically(backup, *old);
        }
    }
    const Result<> written = write_file_atomically(path, content);
    return written.has_value() ? kept : written;
}

Result<int> open_regular_file(const std::string &path, int flags) {
    constexpr mode_t MODE = 0666;
    // The check before open() is for devices, on which open() itself has side effects. The flags cover a file
    // that is replaced between the check and open(). They have no effect on regular files.
    const Result<> before = check_regular(path);
    if (!before.has_value()) {
        return std::unexpected(before.error());
    }
    const int fd = ::open(path.c_str(), flags | O_NONBLOCK | O_NOCTTY | O_CLOEXEC, MODE);
    struct stat status{};
    if (fd < 0) {
        return system_failure((flags & O_ACCMODE) == O_RDONLY ? "open" : "write", path);
    }
    if (::fstat(fd, &status) != 0 || !S_ISREG(status.st_mode)) {
        ::close(fd);
        return not_regular(path, status.st_mode);
    }
    return fd;
}

Result<std::string> read_file(const std::string &path, std::size_t most_bytes) {
    const auto opened = open_regular_file(path);
    if (!opened.has_value()) {
        return std::unexpected(opened.error());
    }
    const FileHandle file(*opened);
    std::string content;
    struct stat status{};
    if (::fstat(file.get(), &status) == 0 && status.st_size > 0) {
        if (static_cast<std::uint64_t>(status.st_size) > most_bytes) {
            return fail(path + " is too large: it has more than " + std::to_string(most_bytes >> 20U) +
                        " MB");
        }
        content.reserve(static_cast<std::size_t>(status.st_size) + 1);
    }
    while (true) {
        constexpr std::size_t STEP = 65536;  // [bytes] for a file that does not report its size
        const std::size_t had = content.size();
        ssize_t n = 0;
        // Reads into the string directly, without a second copy of a large program.
        content.resize_and_overwrite(had < content.capacity() ? content.capacity() : had + STEP,
                                     [&](char *bytes, std::size_t size) {
                                         n = ::read(file.get(), bytes + had, size - had);
                                         return had + static_cast<std::size_t>(std::max<ssize_t>(n, 0));
                                     });
        if (n < 0 && errno == EINTR) {
            continue;
        }
        if (n < 0) {
            return system_failure("read", path);
        }
        if (n == 0) {
            return content;
        }
        if (content.size() > most_bytes) {  // the file grew while it was read
            return fail(path + " is too large: it has more than " + std::to_string(most_bytes >> 20U) +
                        " MB");
        }
    }
}

}  // namespace mw

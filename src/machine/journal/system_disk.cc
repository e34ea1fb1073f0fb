// SPDX-License-Identifier: GPL-2.0-or-later
#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>

#include "base/atomic_file.hh"
#include "machine/journal/disk.hh"

namespace mw::journal {
namespace {

constexpr mode_t MODE = 0644;

std::unexpected<Error> trouble(const char *doing, const std::string &path) {
    return fail(std::string("cannot ") + doing + " '" + path + "': " + std::strerror(errno), {path, 0, 0});
}

struct File {
    int fd;
    File(const std::string &path, int flags) : fd(::open(path.c_str(), flags | O_CLOEXEC, MODE)) {}
    File(const File &) = delete;
    File &operator=(const File &) = delete;
    ~File() {
        if (fd >= 0) {
            ::close(fd);
        }
    }
};

Result<> write_all(const std::string &path, int flags, std::string_view bytes) {
    const File file(path, flags);
    if (file.fd < 0) {
        return trouble("open", path);
    }
    while (!bytes.empty()) {
        const ssize_t n = ::write(file.fd, bytes.data(), bytes.size());
        if (n < 0 && errno == EINTR) {
            continue;
        }
        if (n <= 0) {
            return trouble("write", path);
        }
        bytes.remove_prefix(static_cast<std::size_t>(n));
    }
    return {};
}

class SystemDisk final : public Disk {
  public:
    Result<> rewrite(const std::string &path, std::string_view bytes) override {
        return write_file_atomically(path, bytes);
    }
    bool exists(const std::string &path) override { return ::access(path.c_str(), F_OK) == 0; }
    Result<std::string> read(const std::string &path) override { return read_file(path); }
    Result<> write_new(const std::string &path, std::string_view bytes) override {
        return write_all(path, O_WRONLY | O_CREAT | O_TRUNC, bytes);
    }
    Result<> append(const std::string &path, std::string_view bytes) override {
        return write_all(path, O_WRONLY | O_APPEND, bytes);
    }
    Result<> sync(const std::string &path) override {
        const File file(path, O_RDONLY);
        return file.fd >= 0 && ::fdatasync(file.fd) == 0 ? Result<>{} : trouble("sync", path);
    }
    Result<> rename(const std::string &from, const std::string &to) override {
        return std::rename(from.c_str(), to.c_str()) == 0 ? Result<>{} : trouble("rename", from);
    }
    Result<> remove(const std::string &path) override {
        return ::unlink(path.c_str()) == 0 || errno == ENOENT ? Result<>{} : trouble("remove", path);
    }
    Result<> sync_folder_of(const std::string &path) override {
        const auto slash = path.rfind('/');
        const std::string folder = slash == std::string::npos ? "." : path.substr(0, slash + 1);
        const File file(folder, O_RDONLY | O_DIRECTORY);
        return file.fd >= 0 && ::fsync(file.fd) == 0 ? Result<>{} : trouble("sync", folder);
    }
};

}  // namespace

std::unique_ptr<Disk> system_disk() {
    return std::make_unique<SystemDisk>();
}

Result<> Disk::rewrite(const std::string &path, std::string_view bytes) {
    return replace_file(*this, path, bytes);
}

Result<> replace_file(Disk &disk, const std::string &path, std::string_view bytes) {
    const std::string temporary = path + ".new";
    auto done = disk.write_new(temporary, bytes);
    done = done.has_value() ? disk.sync(temporary) : done;
    done = done.has_value() ? disk.rename(temporary, path) : done;
    return done.has_value() ? disk.sync_folder_of(path) : done;
}

Result<> rewrite_with_backup(Disk &disk, const std::string &path, std::string_view bytes) {
    Result<> kept;
    if (disk.exists(path)) {
        const auto old = disk.read(path);
        if (!old.has_value()) {
            kept = std::unexpected(old.error());
        } else if (*old != bytes || !disk.exists(backup_of(path))) {
            kept = disk.rewrite(backup_of(path), *old);
        }
    }
    const auto written = disk.rewrite(path, bytes);
    return written.has_value() ? kept : written;
}

}  // namespace mw::journal
